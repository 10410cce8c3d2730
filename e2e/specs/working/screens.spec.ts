import type { Page } from '@playwright/test';
import { findings, outsideCircle, overflow } from '../../station/barriers.ts';
import { picture, restsOnPerson } from '../../station/seen.ts';
import { ADA } from '../../station/station.ts';
import { DESK, expect, test } from '../../station/test.ts';

const SCREENS = [
	[1440, 900],
	[768, 1024],
	[320, 640]
] as const;

/** Where text of twice the size must fit: on 320 pixels it would be that of a page enlarged eight times. */
const ENLARGED = SCREENS.filter(([width]) => width > 320);

const PAGES = ['/', '/restart', '/state', '/alarms', '/history', '/orders', '/wall', '/ros', '/operations', '/model', '/model?view=graph', '/pipelines', '/account', '/journal', '/wearables', '/users', '/api-keys', '/webhooks', '/backups', '/storage'];

/** Doubles the size of all text. */
async function enlarge(page: Page): Promise<void> {
	await page.evaluate(() => (document.documentElement.style.fontSize = '200%'));
}

test('the pages fit their screens @theme', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	for (const [width, height] of SCREENS) {
		await operate.setViewportSize({ width, height });
		expect(await overflow(operate), `pixels to the right of a screen of ${width}`).toBe(0);
		await picture(operate, `operate-${width}`);
	}

	// On a round face the button and the words must lie within the circle.
	expect(await outsideCircle(watch)).toEqual([]);
});

test('mode, alarms and Pause stay in sight wherever the page is scrolled to', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	for (const [width, height] of [...SCREENS, [640, 320] as const]) {
		await operate.setViewportSize({ width, height });
		await operate.evaluate(() => window.scrollTo(0, document.documentElement.scrollHeight));
		await expect(operate.getByTestId('mode')).toBeInViewport({ ratio: 1 });
		await expect(operate.getByTestId('alarm-count')).toBeInViewport({ ratio: 1 });
		await expect(operate.getByRole('button', { name: 'Pause', exact: true })).toBeInViewport({ ratio: 1 });
	}
});

test('no dialog covers mode, alarms, Pause and Hold, and the menu leads to the pages', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.getByRole('button', { name: 'Why? New engine' }).click();
	const dialog = operate.getByRole('dialog');
	await expect(dialog.getByRole('status').first()).toContainText('As it was at');
	for (const [width, height] of [...SCREENS, [640, 320], [192, 192]] as const) {
		await operate.setViewportSize({ width, height });
		const { y } = (await dialog.boundingBox()) ?? { y: 0 };
		for (const each of [
			operate.getByTestId('mode'),
			operate.getByTestId('alarm-count'),
			operate.getByRole('button', { name: 'Pause', exact: true }),
			operate.getByRole('button', { name: 'Hold' })
		]) {
			await expect(each).toBeInViewport({ ratio: 1 });
			await each.click({ trial: true }); // nothing lies over it
			const box = await each.boundingBox();
			expect(box && box.y + box.height, `above the dialog on a screen of ${width}`).toBeLessThanOrEqual(y);
		}
	}
	await operate.keyboard.press('Escape');
	await expect(dialog).toBeHidden();

	await operate.setViewportSize({ width: 390, height: 844 });
	const more = operate.getByRole('button', { name: 'More' });
	await more.press('Enter');
	const pages = operate.getByRole('dialog', { name: 'Pages' });
	await operate.keyboard.press('Tab');
	await expect(pages.getByRole('link', { name: 'Operate' })).toBeFocused();
	await operate.keyboard.press('Escape');
	await expect(more).toBeFocused();
	await expect(pages).toBeHidden();
	await more.press('Enter');
	await pages.getByRole('link', { name: 'Pipelines' }).press('Enter');
	await expect(operate.getByRole('heading', { name: 'Pipelines', level: 1 })).toBeAttached();
	await expect(pages).toBeHidden();
	await expect(operate.getByRole('button', { name: 'Pipelines, More' })).toBeVisible();
});

test('text of twice the size is still all there where much is shown', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await enlarge(operate);
	for (const [width, height] of ENLARGED) {
		await operate.setViewportSize({ width, height });
		expect(await overflow(operate), `pixels to the right of a screen of ${width}`).toBe(0);
	}
});

test.describe('every page', () => {
	test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

	for (const [language, locale, tag] of [
		['English', 'en-GB', ''],
		['Swedish', 'sv-SE', ' @long']
	] as const) {
		test(`in ${language}${tag} has all there on small screens, in large text and in forced colours`, async ({ browse }) => {
			test.setTimeout(240_000); // there are many
			const page = await browse(ADA, '/', { ...DESK, locale });
			for (const path of PAGES) {
				await page.goto(path);
				await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
				await expect(page.getByRole('heading', { level: 1 })).toBeAttached();
				for (const [width, height] of SCREENS) {
					await page.setViewportSize({ width, height });
					expect.soft(await overflow(page), `${path}: pixels to the right of a screen of ${width}`).toBe(0);
				}
				await page.emulateMedia({ forcedColors: 'active' });
				expect.soft(await findings(page, ['color-contrast', 'link-in-text-block']), path).toEqual([]);
				await page.emulateMedia({ forcedColors: 'none' });
				await enlarge(page);
				for (const [width, height] of ENLARGED) {
					await page.setViewportSize({ width, height });
					expect.soft(await overflow(page), `${path}: pixels to the right of a screen of ${width}, enlarged`).toBe(0);
				}
			}
		});
	}
});

test('History tells what was done in the language of the page, though it was recorded in English', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const page = await browse(null, '/history', { ...DESK, locale: 'sv-SE' });
	await expect(page.locator('main')).toContainText('Sätt i skruvpar', { timeout: 30_000 });
	await expect(page.locator('main')).not.toContainText('Place bolt pair');
});

test('the theme that was chosen is kept', async ({ operate }) => {
	const ground = (): Promise<string> =>
		operate.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
	const light = await ground();
	await operate.getByTestId('who').click();
	await operate.getByRole('button', { name: 'Theme: auto' }).click();
	await operate.getByRole('button', { name: 'Theme: light' }).click();
	await expect(operate.getByRole('button', { name: 'Theme: dark' })).toBeVisible();
	const dark = await ground();
	expect(dark).not.toBe(light);
	await operate.reload();
	await operate.getByTestId('who').click();
	await expect(operate.getByRole('button', { name: 'Theme: dark' })).toBeVisible();
	expect(await ground()).toBe(dark);
});
