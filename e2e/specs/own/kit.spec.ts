import type { Locator, Page } from '@playwright/test';
import { readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { findings, overflow, smallTargets } from '../../station/barriers.ts';
import { buildKit, KIT, serveKit } from '../../station/kit.ts';
import { picture } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

const WIDTHS = [320, 390, 768, 1440];
const PARTS = join(import.meta.dirname, '../../../frontend/src/lib/ui');
/** What is opened by a button, and closed by Escape. */
const OVERLAYS = ['Dialog', 'Wide dialog', 'Reason dialog', 'Drawer'];

test.beforeAll(buildKit);

/** Opens the page, with what stays in sight as high as the top bar of a station's pages; complaints of the browser are kept. */
async function openKit(page: Page, complaints: string[], query = ''): Promise<void> {
	page.on('console', (message) => {
		if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
	});
	page.on('pageerror', (error) => complaints.push(error.message));
	await serveKit(page.context());
	await page.goto(`${KIT}${query}`);
	await expect(page.getByRole('heading', { name: 'Kit', level: 1 })).toBeVisible();
	await expect(page.getByTestId('not-live')).toHaveCount(query === '' ? 0 : 1);
}

async function swedish(page: Page): Promise<void> {
	await page.getByRole('button', { name: 'Svenska' }).click();
	await expect(page.locator('html')).toHaveAttribute('lang', 'sv');
}

/** What keeps people from the page as it is now, on all screens. */
async function look(page: Page, what: string): Promise<void> {
	for (const width of WIDTHS) {
		await page.setViewportSize({ width, height: 900 });
		expect.soft(await overflow(page), `${what}: pixels to the right of ${width}`).toBe(0);
		expect.soft(await smallTargets(page), `${what}: too small at ${width}`).toEqual([]);
		await picture(page, `kit-${what}-${width}`);
	}
	expect.soft(await findings(page), what).toEqual([]);
}

const toast = (page: Page): Locator => page.getByTestId('toasts');

test('every part of the kit is shown in both languages, themes and forced colours, on all screens', async ({ page, complaints }) => {
	await openKit(page, complaints);
	const shown = await page.locator('[data-part]').evaluateAll((all) => all.map((each) => each.getAttribute('data-part')));
	const parts = (await readdir(PARTS)).filter((each) => each.endsWith('.svelte')).map((each) => each.replace('.svelte', ''));
	expect(parts.filter((each) => !shown.includes(each))).toEqual([]);
	expect(await page.evaluate(() => document.fonts.check('1em "Inter Variable"'))).toBe(true);

	await look(page, 'en');
	await page.emulateMedia({ colorScheme: 'dark' });
	expect.soft(await findings(page, ['color-contrast']), 'dark').toEqual([]);
	await picture(page, 'kit-1440', 'dark');
	await page.emulateMedia({ colorScheme: 'light', forcedColors: 'active' });
	expect.soft(await findings(page), 'forced colours').toEqual([]);
	await picture(page, 'kit-1440', 'forced');
	await page.emulateMedia({ forcedColors: 'none' });
	await swedish(page);
	await look(page, 'sv');
	expect(complaints).toEqual([]);
});

test('what opens over the page fits every screen, takes the focus, and gives it back with Escape', async ({ page, complaints }) => {
	await openKit(page, complaints);
	for (const name of OVERLAYS) {
		const button = page.getByRole('button', { name, exact: true });
		await button.click();
		await expect(page.getByRole('dialog').getByRole('heading')).toBeFocused();
		await look(page, name.toLowerCase().replace(' ', '-'));
		await page.emulateMedia({ forcedColors: 'active' });
		expect.soft(await findings(page), `${name}, forced colours`).toEqual([]);
		await page.emulateMedia({ forcedColors: 'none' });
		await page.keyboard.press('Escape');
		await expect(page.getByRole('dialog')).toHaveCount(0);
		await expect(button).toBeFocused();
	}
	expect(complaints).toEqual([]);
});

test('what is asked for with a reason is told where it is refused, and the reason stays', async ({ page, complaints }) => {
	await openKit(page, complaints);
	await page.getByRole('button', { name: 'Reason dialog' }).click();
	const dialog = page.getByRole('dialog');
	await dialog.getByLabel('Reason').fill('?');
	await dialog.getByRole('button', { name: 'Take out of service' }).click();
	await expect(dialog.getByRole('alert')).toContainText('Refused');
	await expect(dialog.getByLabel('Reason')).toHaveValue('?');
	await dialog.getByLabel('Reason').fill('It is being repaired');
	await page.keyboard.press('Tab');
	await page.keyboard.press('Tab');
	await page.keyboard.press('Enter');
	await expect(dialog).toHaveCount(0);
	await expect(page.getByTestId('done')).toHaveText('It is being repaired');
});

test('while the station is not heard the kit says so, and lets nothing be sent', async ({ page, complaints }) => {
	await openKit(page, complaints, '?old');
	await expect(page.locator('[data-part="panel"]').getByText(/^as it was at \d/)).toBeVisible();
	await page.getByRole('button', { name: 'Reason dialog' }).click();
	await expect(page.getByRole('dialog').getByRole('button', { name: 'Take out of service' })).toHaveAttribute('aria-disabled', 'true');
	await look(page, 'old');
});

test('what was done is told for six seconds, and as long as somebody points at it', async ({ page, complaints }) => {
	await openKit(page, complaints);
	await page.clock.install();
	const button = page.getByRole('button', { name: 'Toast', exact: true });
	await button.press('Enter');
	await expect(toast(page)).toHaveText(/The alarm is out of service/);
	await page.clock.fastForward(5500);
	await expect(toast(page)).toHaveText(/The alarm is out of service/);
	await page.clock.fastForward(1000);
	await expect(toast(page)).toHaveText('');

	await button.press('Enter');
	await toast(page).locator('p').hover();
	await page.clock.fastForward(60_000);
	await expect(toast(page)).toHaveText(/The alarm is out of service/);
	await page.mouse.move(0, 0);
	await page.clock.fastForward(6500);
	await expect(toast(page)).toHaveText('');
});

test('what was done is taken back with the mouse or by keyboard alone, over whatever is open', async ({ page, complaints }) => {
	await openKit(page, complaints);
	const button = page.getByRole('button', { name: 'Toast to take back' });
	await button.click();
	await page.getByRole('button', { name: 'Drawer' }).click();
	await toast(page).getByRole('button', { name: 'Take back' }).click();
	await expect(page.getByTestId('done')).toHaveText('Taken back at once');
	await expect(toast(page)).toHaveText('');
	await page.keyboard.press('Escape');

	await button.focus();
	await page.keyboard.press('Enter');
	await page.keyboard.press('F8');
	await expect(toast(page).getByRole('button', { name: 'Take back' })).toBeFocused();
	await page.keyboard.press('Escape');
	await expect(toast(page)).toHaveText('');
	await expect(button).toBeFocused();

	await page.getByRole('button', { name: 'Toast refused' }).click();
	await page.keyboard.press('F8');
	await page.keyboard.press('Enter');
	await expect(page.getByRole('alert').filter({ hasText: 'Refused' }).last()).toBeVisible();
	await page.getByRole('button', { name: 'Close' }).last().click();
	expect(complaints).toEqual([]);
});

test('what was done never lies over the bar, and stands still for whoever wants no motion', async ({ page, complaints }) => {
	await openKit(page, complaints);
	for (const [width, height] of [[1440, 900], [320, 640], [640, 320]] as const) {
		await page.setViewportSize({ width, height });
		for (const name of ['Toast', 'Toast to take back', 'Toast refused']) await page.getByRole('button', { name, exact: true }).press('Enter');
		await page.evaluate(() => window.scrollTo(0, 0));
		await expect(toast(page).locator('p')).toHaveCount(3);
		for (const id of ['pause', 'hold']) await page.getByTestId(id).click({ trial: true });
		expect.soft(await overflow(page)).toBe(0);
		expect.soft(await smallTargets(page)).toEqual([]);
		await picture(page, `kit-toasts-${width}`);
	}
	expect.soft(await findings(page)).toEqual([]);
	await page.emulateMedia({ reducedMotion: 'reduce' });
	await page.getByRole('button', { name: 'Toast', exact: true }).press('Enter');
	expect(await toast(page).evaluate((said) => said.getAnimations({ subtree: true }).length)).toBe(0);
});

test('the kit is no page of a station', async ({ operate, station }) => {
	const answer = await operate.request.get(`${station.url}/kit`);
	expect(answer.status()).toBe(404);
	await operate.goto(`${station.url}/kit`);
	await expect(operate.locator('[data-part]')).toHaveCount(0);
});
