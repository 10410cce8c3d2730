/** The frame of the pages: the rail, the bar, the palette, the keys. */
import { findings, overflow } from '../../station/barriers.ts';
import { picture, startProduction, takeControl } from '../../station/seen.ts';
import { ADA, ADAM, EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';
import type { Page } from '@playwright/test';

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

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
	await expect(palette.getByRole('option', { name: 'Pose of the robot robot.pose', exact: true })).toBeVisible();
	await typed.fill('robot.pose');
	await page.keyboard.press('Enter');
	await expect(page).toHaveURL(/\/state\?search=robot\.pose$/);
	await expect(palette).toBeHidden();

	await page.keyboard.press('Control+k');
	await typed.fill('why new engine');
	await page.keyboard.press('Enter');
	await expect(page.getByRole('dialog', { name: 'What “New engine” waits for' })).toBeVisible();
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

test('on a small screen control is taken and given back in two presses, by keyboard too, and the bar stays one row', async ({ browse }) => {
	const [eva, adam] = [await browse(EVA, '/alarms'), await browse(ADAM, '/alarms')];
	for (const page of [eva, adam]) {
		// Work goes on: what stands below the bar while somebody has to go on is not there.
		await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
		await page.setViewportSize({ width: 768, height: 1024 });
	}
	await startProduction(eva);
	const who = (page: Page) => page.getByTestId('who');
	const control = (page: Page) => page.getByTestId('control');

	await expect(who(adam)).toContainText('Control: Eva');
	await who(eva).press('Enter');
	await expect(control(eva)).toHaveAttribute('data-holder', 'you');
	await eva.keyboard.press('Tab');
	await expect(eva.getByRole('button', { name: 'Release control' })).toBeFocused();
	await eva.keyboard.press('Enter');
	await expect(control(eva)).toHaveAttribute('data-holder', 'nobody');
	await expect(eva.getByRole('button', { name: 'Take control' })).toBeVisible();
	expect(await findings(eva)).toEqual([]);
	await picture(eva, 'control-768');
	await eva.keyboard.press('Escape');
	await expect(who(eva)).toBeFocused();
	await expect(who(adam)).toContainText('Control: nobody');

	for (const width of [768, 390, 320]) {
		await adam.setViewportSize({ width, height: 844 });
		expect((await adam.getByTestId('strip').boundingBox())?.height, `the bar on a screen of ${width}`).toBeLessThanOrEqual(56);
		expect(await overflow(adam)).toBe(0);
		await who(adam).click();
		await adam.getByRole('button', { name: 'Take control' }).click();
		await expect(control(adam)).toHaveAttribute('data-holder', 'you');
		await expect(who(eva)).toContainText('Control: Adam');
		await adam.getByRole('button', { name: 'Release control' }).click();
		await expect(control(adam)).toHaveAttribute('data-holder', 'nobody');
		await adam.keyboard.press('Escape');
	}

	// Taken over, from a small screen too.
	await takeControl(adam);
	await takeControl(eva);
	await expect(who(adam)).toContainText('Control: Eva');
	await eva.getByRole('button', { name: 'Release control' }).click();
	await expect(control(eva)).toHaveAttribute('data-holder', 'nobody');
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

test('a typed address that leads nowhere is told once, and leads to the station', async ({ browse }) => {
	const page = await browse(EVA, '/operate');
	await expect(page.getByRole('heading', { name: 'There is no such page' })).toBeVisible();
	let loads = 0;
	page.on('load', () => (loads += 1));
	expect(await findings(page)).toEqual([]);
	await page.getByRole('link', { name: 'To the station' }).click();
	await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	expect(loads).toBe(0);
});
