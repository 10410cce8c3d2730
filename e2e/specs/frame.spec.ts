/** The frame of the pages: the rail, the bar, the palette, the keys. */
import { findings, overflow } from '../station/barriers.ts';
import { picture, takeControl } from '../station/seen.ts';
import { ADA, EVA } from '../station/station.ts';
import { expect, test } from '../station/test.ts';

test.use({ shared: 'staffed', byItself: false, people: 'everybody' });

test('pages, variables and acts are found by a few letters, by keyboard alone', async ({ browse }) => {
	const page = await browse(EVA, '/');
	await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	await page.keyboard.press('Control+k');
	const palette = page.getByRole('dialog', { name: 'Search or act' });
	const typed = palette.getByRole('combobox');
	await expect(typed).toBeFocused();
	await expect(palette.getByRole('option', { name: 'Pause', exact: true })).toBeVisible();
	// What this session may not do now is not offered.
	await expect(palette.getByRole('option', { name: 'Continue', exact: true })).toHaveCount(0);
	expect(await findings(page)).toEqual([]);
	await picture(page, 'palette');

	await typed.fill('robot pose');
	const first = palette.getByRole('option').first();
	await expect(first).toHaveAttribute('aria-selected', 'true');
	await expect(palette.getByRole('option', { name: 'robot.pose', exact: true })).toBeVisible();
	await typed.fill('robot.pose');
	await page.keyboard.press('Enter');
	await expect(page).toHaveURL(/\/state\?search=robot\.pose$/);
	await expect(palette).toBeHidden();

	await page.keyboard.press('Control+k');
	await typed.fill('why new engine');
	await page.keyboard.press('Enter');
	await expect(page.getByRole('dialog', { name: 'What New engine waits for' })).toBeVisible();
	await page.keyboard.press('Escape');

	await page.keyboard.press('Control+k');
	await typed.fill('nowhere to be found');
	await expect(palette.getByRole('status').filter({ hasText: 'Nothing is called' })).toBeVisible();
	await page.keyboard.press('Escape');
	await expect(palette).toBeHidden();
});

test('an act is done from the palette, and what is possible then is another', async ({ browse }) => {
	const page = await browse(EVA, '/alarms');
	await takeControl(page);
	await page.getByRole('button', { name: /^Search or act/ }).click();
	await page.getByRole('option', { name: 'Release control' }).click();
	await expect(page.getByTestId('control')).toHaveAttribute('data-holder', 'nobody');
});

test('the rail is made slim, which the browser remembers, and the keys are told', async ({ browse }) => {
	const page = await browse(EVA, '/');
	const rail = page.getByRole('navigation', { name: 'Pages' });
	const width = async (): Promise<number> => (await rail.boundingBox())?.width ?? 0;
	const wide = await width();
	await page.getByRole('button', { name: 'Collapse' }).click();
	expect(await width()).toBeLessThan(wide / 2);
	await page.reload();
	await expect(rail).toBeVisible();
	expect(await width()).toBeLessThan(wide / 2);
	// The names are there for who does not see the marks.
	await expect(rail.getByRole('link', { name: 'Alarms' })).toBeVisible();
	expect(await findings(page)).toEqual([]);
	await page.getByRole('button', { name: 'Expand' }).click();

	await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	await page.keyboard.press('?');
	await expect(page.getByRole('dialog', { name: 'Operate: what you do here' })).toContainText('Search or act');
	await page.keyboard.press('Escape');
	await page.keyboard.press('Tab');
	expect(await overflow(page)).toBe(0);
});

test('every page has its help: a picture whose numbers are those of the lines @theme', async ({ browse }) => {
	const page = await browse(ADA, '/');
	const rail = page.getByRole('navigation', { name: 'Pages' });
	const help = page.getByRole('dialog');
	await expect(rail.getByRole('link', { name: 'Storage' })).toBeVisible();
	// A mark may stand beside it.
	const titles = (await rail.getByRole('link').allInnerTexts()).map((shown) => shown.trim().split('\n')[0] ?? '');
	// The wall, which has no rail, comes last.
	const wall = titles.indexOf('Wall view');
	expect(wall).toBeGreaterThan(0);
	// The first is open already: to go there once more would close what is opened meanwhile.
	for (const title of [...titles.toSpliced(wall, 1), 'Account', 'Wall view']) {
		if (title === 'Account') await page.goto(new URL('/account', page.url()).href);
		else if (title !== titles[0]) await rail.getByRole('link', { name: new RegExp(`^${title}\\b`) }).click();
		const button = page.getByRole('main').getByRole('button', { name: `Help: ${title}`, exact: true });
		await button.press('Enter');
		await expect(help.getByRole('heading', { name: `${title}: what you do here` })).toBeFocused();
		const lines = await help.getByRole('listitem').count();
		expect(lines, title).toBeGreaterThan(1);
		expect(lines, title).toBeLessThan(10);
		const numbers = await help.getByTestId('help-picture').locator('text').allTextContents();
		expect(numbers, title).toEqual(numbers.map((_, at) => String(at + 1)));
		expect(numbers.length, title).toBeLessThanOrEqual(lines);
		if (title === 'Restart') {
			expect(await findings(page)).toEqual([]);
			await page.setViewportSize({ width: 320, height: 640 });
			expect(await overflow(page)).toBe(0);
			await page.setViewportSize({ width: 1440, height: 900 });
		}
		await page.keyboard.press('Escape');
		await expect(help).toHaveCount(0);
		await expect(button).toBeFocused();
	}
});
