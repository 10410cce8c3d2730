/**
 * What interface figures there are: how fast a page is there, how much script it brings, and whether it stays smooth and
 * small beside a station of 5000 variables of which 500 change ten times a second.
 *
 * `MINUTES` is how long each busy page is watched (10 unless it says otherwise). The report goes to `docs/campaigns/pages.md`.
 */
import type { Browser, Page } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { EVA, Station } from '../station/station.ts';
import { expect, test } from '../station/test.ts';
import { framesOf, heapOf } from './frames.ts';
import { opened, prepare } from './moments.ts';
import { scriptsOf } from './size.ts';

const ROOT = resolve(import.meta.dirname, '../..');
const PYTHON = join(ROOT, 'backend/.venv/bin/python');
const BUSY = join(import.meta.dirname, 'busy_station.py');
const MINUTES = Number(process.env['MINUTES'] ?? '10');
const VISITS = 7;
const REPORT = join(ROOT, 'docs/campaigns/pages.md');

const rows: string[] = [];
const lines: string[] = [];
const pictures: string[] = [];

/** What Operate is opened for. */
const OPERATE = [
	{ selector: '[data-testid="strip"][data-live="true"]' },
	{ selector: '[data-testid="mimic"] [data-symbol]' },
	{ selector: '[data-step]' },
	{ selector: '[data-operation]' }
];

/** A page in a browser context of its own. */
async function signedIn(browser: Browser, station: Station): Promise<Page> {
	const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
	await context.addCookies([{ ...(await station.signIn(EVA)), url: station.url }]);
	return context.newPage();
}

/** Milliseconds from the call of an address until the page shows the station live. */
async function firstView(browser: Browser, station: Station, address: string): Promise<number> {
	const page = await signedIn(browser, station);
	const began = performance.now();
	await page.goto(`${station.url}${address}`, { waitUntil: 'commit' });
	await page.locator('[data-testid="strip"][data-live="true"]').waitFor();
	const took = performance.now() - began;
	await page.context().close();
	return took;
}

function median(numbers: readonly number[]): number {
	return [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)] ?? NaN;
}

test('the pages of a station at work', async ({ browser }) => {
	const station = await Station.start({ byItself: true, devices: false, people: [], logs: join(ROOT, 'e2e/artefacts/logs/figures') });
	try {
		const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
		const page = await context.newPage();
		for (const address of ['/', '/restart', '/state', '/alarms', '/history', '/ros', '/operator']) {
			const fresh = await browser.newContext();
			const visited = await fresh.newPage();
			const kilobytes = await scriptsOf(visited, async () => {
				await visited.goto(`${station.url}${address}`);
				await visited.waitForLoadState('networkidle', { timeout: 5000 }).catch(() => undefined);
			});
			await fresh.close();
			lines.push(`| \`${address}\` | ${kilobytes.toFixed(0)} kB |`);
		}
		await page.goto(station.url);
		await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
		const views: number[] = [];
		for (let visit = 0; visit < VISITS; visit += 1) {
			const again = await browser.newContext({ viewport: { width: 1440, height: 900 } });
			const shown = await again.newPage();
			await prepare(shown);
			views.push(await opened(shown, station.url, ...OPERATE));
			await again.close();
		}
		lines.push('', `Operate shows its picture, its plan and its operations ${(median(views) / 1000).toFixed(2)} s after its address was called, in a browser that has seen nothing of it (median of ${VISITS}; at least ${(Math.min(...views) / 1000).toFixed(2)} s, at most ${(Math.max(...views) / 1000).toFixed(2)} s).`);
	} finally {
		await station.stop();
	}
});

test('the live picture with drawings of its own, while the station works', async ({ browser }) => {
	const logs = join(ROOT, 'e2e/artefacts/logs/figures-picture');
	const station = await Station.start({ byItself: true, devices: false, people: [], model: 'models/truck_engine_station', logs });
	try {
		const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
		await page.goto(station.url);
		await expect(page.locator('[data-drawing]').first()).toBeVisible();
		const seconds = Math.min(60, MINUTES * 60);
		const frames = await framesOf(page, seconds);
		pictures.push(`Beside the working truck engine station Operate, whose picture has drawings of its own, draws ${frames.mean.toFixed(1)} frames a second for ${seconds} s, ${frames.worst} in the worst of them.`);
		await page.context().close();
	} finally {
		await station.stop();
	}
});

test('the pages of a station of 5000 variables of which 500 change ten times a second', async ({ browser }) => {
	const folder = mkdtempSync(join(tmpdir(), 'busy-'));
	execFileSync(PYTHON, [BUSY, 'model', join(folder, 'model')]);
	const station = await Station.start({
		byItself: false,
		devices: false,
		people: [EVA],
		model: join(folder, 'model'),
		beside: [PYTHON, [BUSY, 'speak', join(folder, 'model')]],
		logs: join(ROOT, 'e2e/artefacts/logs/figures')
	});
	try {
		for (const address of ['/', '/state']) {
			const first = await firstView(browser, station, address);
			const page = await signedIn(browser, station);
			const session = await page.context().newCDPSession(page);
			await page.goto(`${station.url}${address}`);
			await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
			await page.waitForTimeout(15_000); // what is kept for a while fills up first
			const heap = await heapOf(session);
			const frames = await framesOf(page, MINUTES * 60);
			const after = await heapOf(session);
			rows.push(
				`| \`${address}\` | ${(first / 1000).toFixed(2)} s | ${frames.mean.toFixed(1)} | ${frames.worst} | ${heap.toFixed(1)} MB | ${after.toFixed(1)} MB |`
			);
			await page.context().close();
		}
	} finally {
		await station.stop();
		rmSync(folder, { recursive: true });
	}
});

test.afterAll(() => {
	const commit = execFileSync('git', ['describe', '--always', '--dirty'], { cwd: ROOT, encoding: 'utf8' }).trim();
	const text = [
		'# The pages in Chromium',
		'',
		`Made by \`make figures\` at commit ${commit} on ${cpus().length} cores, beside all processes of the station; a page is watched for ${MINUTES} minutes.`,
		'',
		'Scripts that a page loads, compressed as the server sends them:',
		'',
		'| page | scripts |',
		'|---|---|',
		...lines,
		'',
		...pictures,
		'',
		'Beside a station of 5000 variables of which 500 change ten times a second:',
		'',
		'| page | live after | frames a second | in the worst second | memory in use | at the end |',
		'|---|---|---|---|---|---|',
		...rows,
		''
	].join('\n');
	writeFileSync(REPORT, text);
	console.log(text);
});
