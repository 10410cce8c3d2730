/** A station that nobody would wish on a page: no titles, long names, much of everything, and a picture that means harm. */
import type { Locator, Page } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { findings, overflow, smallTargets } from '../../station/barriers.ts';
import { crowded, spaceOut } from '../../station/room.ts';
import { picture } from '../../station/seen.ts';
import { ROOT, Station } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

const PAGES = ['/', '/wall', '/state', '/alarms', '/restart', '/history', '/orders'];
const WATCH = '/operator';
const SCREENS = [
	[1920, 1080],
	[1440, 900],
	[768, 1024],
	[390, 844],
	[320, 640],
	[320, 256] // a desk of 1280 × 1024, enlarged four times
] as const;
/** Drawings of which something is left that nobody needs to fear. */
const KEPT = ['script', 'handler', 'link', 'foreign', 'style', 'use', 'animate', 'itself'];

const folder = mkdtempSync(join(tmpdir(), 'unkind-'));
let station: Station;
/** What the pages asked of anybody but their server, and what opened by itself. */
const strayed: string[] = [];


test.setTimeout(180_000);

test.beforeAll(async ({}, info) => {
	const model = join(folder, 'model');
	execFileSync(join(ROOT, 'backend/.venv/bin/python'), [join(ROOT, 'e2e/station/unkind.py'), model, '--hostile']);
	station = await Station.start({ byItself: true, devices: false, people: [], model, logs: join(ROOT, 'e2e/artefacts/logs', `unkind-${info.project.name}`) });
});

test.afterAll(async () => {
	await station.stop();
	rmSync(folder, { recursive: true });
});

async function go(page: Page, path: string): Promise<void> {
	await page.goto(`${station.url}${path}`);
	if (path === WATCH) await expect(page.getByRole('heading')).toBeVisible();
	else await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
}

function listen(page: Page): void {
	page.on('request', (request) => {
		const { protocol, origin } = new URL(request.url());
		if (!['data:', 'blob:'].includes(protocol) && origin !== station.url) strayed.push(request.url());
	});
	page.on('dialog', (dialog) => {
		strayed.push(dialog.message());
		void dialog.dismiss();
	});
}

const drawing = (page: Page, name: string): Locator => page.getByTestId('mimic').locator(`[data-drawing="${name}.svg"]`);

test('no drawing runs or loads anything; what can be drawn of it is, and what cannot is told with its place', async ({ page }) => {
	listen(page);
	await go(page, '/');
	for (const name of KEPT) await expect(drawing(page, name).locator('circle').first()).toBeVisible();
	for (const name of ['bomb', 'broken', 'missing']) await expect(drawing(page, name)).toHaveCount(0);
	for (const name of KEPT) await drawing(page, name).dispatchEvent('click'); // a handler would run by it
	await expect(page.locator('[data-drawing] :is(script, a, image, foreignObject, style, animate, set)')).toHaveCount(0);
	await page.getByText(/things of mimic.yaml are not drawn/).click();
	await expect(page.getByText(/drawings\/broken\.svg, line 1, column \d+: this is no SVG/).first()).toBeVisible();
	await expect(page.getByText(/mimic\.yaml, line 3, column \d+: there is no resource/).first()).toBeVisible();
	expect(await page.evaluate(() => 'ran' in globalThis)).toBe(false);
	expect(strayed).toEqual([]);
});

test('names of 80 characters and twelve alarms have room on the pages of an operator @theme', async ({ page }) => {
	for (const path of ['/', '/alarms', WATCH]) {
		await go(page, path);
		for (const [width, height] of [SCREENS[1], SCREENS[4]]) {
			await page.setViewportSize({ width, height });
			expect.soft(await overflow(page), `${path}: pixels to the right of a screen of ${width}`).toBe(0);
			expect.soft(await crowded(page), `${path} on a screen of ${width}`).toEqual([]);
		}
	}
});

for (const locale of ['en-GB', 'sv-SE'])
	test(`all pages have room on all screens, in ${locale}, enlarged and spaced out @theme @long`, async ({ browser, colorScheme }) => {
		test.setTimeout(900_000);
		const context = await browser.newContext({ locale, colorScheme: colorScheme ?? 'light' });
		const page = await context.newPage();
		listen(page);
		for (const path of [...PAGES, WATCH]) {
			await go(page, path);
			if (path === '/') await expect(page.locator('[data-step]').nth(100)).toBeAttached({ timeout: 120_000 }); // the plan
			const screens = path === WATCH ? [...SCREENS, [192, 192] as const] : SCREENS;
			for (const spaced of [false, true]) {
				if (spaced) await spaceOut(page);
				for (const [width, height] of screens) {
					const where = `${path} on ${width} × ${height}${spaced ? ', spaced out' : ''}`;
					await page.setViewportSize({ width, height });
					expect.soft(await overflow(page), `${where}: pixels to the right`).toBe(0);
					expect.soft(await crowded(page), where).toEqual([]);
					if (!spaced) expect.soft(await smallTargets(page), `${where}: too small`).toEqual([]);
					await picture(page, `unkind${path.replace('/', '-')}-${width}x${height}-${locale}${spaced ? '-spaced' : ''}`);
				}
			}
			expect.soft(await findings(page), path).toEqual([]);
		}
		expect(strayed).toEqual([]);
		await context.close();
	});
