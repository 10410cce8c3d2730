import type { Locator, Page } from '@playwright/test';
import { examine, findings } from '../../station/barriers.ts';
import { takeControl } from '../../station/seen.ts';
import { ERIK, INA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

const FILE = 'mimic.yaml';
const at = (...steps: string[]): string => `/model?${new URLSearchParams({ entry: steps.join('#') })}`;
const thing = (page: Page, name: string): Locator => page.locator(`[data-thing="${name}"]`);
const card = (page: Page): Locator => page.getByTestId('draft-picture');
const form = (page: Page): Locator => page.getByRole('region', { name: 'Chosen part' });
const undo = (page: Page): Locator => page.getByRole('button', { name: /^Undo: / });

/** Until the picture is that of the file as it is. */
const drawn = (page: Page, by: 'file' | 'model'): Promise<void> => expect(card(page).and(page.locator(`[data-made-from="${by}"][data-drawn="true"]`))).toBeVisible({ timeout: 20_000 });

/** The lines that are others, of what was there and of what is there now. */
function others(before: string, now: string): [string[], string[]] {
	const [old, young] = [before.split('\n'), now.split('\n')];
	expect(young).toHaveLength(old.length);
	const differ = old.flatMap((line, number) => (line === young[number] ? [] : [number]));
	return [differ.map((number) => old[number]?.trim() ?? ''), differ.map((number) => young[number]?.trim() ?? '')];
}

/** Drags something by the mouse so many pixels from a place in it. */
async function drag(page: Page, what: Locator, by: [x: number, y: number]): Promise<void> {
	const box = await what.boundingBox();
	if (box === null) throw new Error('it is not in sight');
	const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
	await page.mouse.move(x, y);
	await page.mouse.down();
	await page.mouse.move(x + by[0] / 2, y + by[1] / 2, { steps: 4 });
	await page.mouse.move(x + by[0], y + by[1], { steps: 4 });
	await page.mouse.up();
}

test.describe('the picture of a draft', () => {
	test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

	test('is moved by mouse and by keys, and only numbers of the file become others', async ({ browse, drafting, complaints }) => {
		const text = async (): Promise<string> => (await drafting.files()).get(FILE) ?? '';
		const before = await text();
		const page = await browse(INA, at(FILE));
		await drawn(page, 'file');
		expect(await findings(page)).toEqual([]);

		// By mouse: it is where it was dropped at once, and one change of the draft.
		const scene = thing(page, 'planning_scene');
		await expect(scene).toHaveAccessibleName('Planning scene: at 24, 236');
		await drag(page, scene, [0, 40]);
		await expect(undo(page)).toHaveAccessibleName('Undo: planning_scene moved in the picture');
		await expect(scene).not.toHaveAccessibleName('Planning scene: at 24, 236');
		await expect(form(page).getByRole('heading').first()).toContainText('Planning scene');
		const [was, is] = others(before, await text());
		expect(was).toEqual(['at: [24, 236]']);
		expect(is).toHaveLength(1);
		expect(is[0]).toMatch(/^at: \[24, 2[67]\d\]$/);
		await undo(page).click();
		await expect(scene).toHaveAccessibleName('Planning scene: at 24, 236');
		expect(await text()).toBe(before);

		// By keys, with what is said of it; several presses are one change.
		await scene.focus();
		await page.keyboard.press('Shift+ArrowDown');
		await page.keyboard.press('ArrowRight');
		await expect(page.getByTestId('moved')).toHaveText('Planning scene: at 25, 244');
		await expect.poll(text).toContain('at: [25, 244]');
		await expect(scene).toBeFocused();
		expect(others(before, await text())).toEqual([['at: [24, 236]'], ['at: [25, 244]']]);

		// The corner, and a field of the form.
		await page.locator('[data-corner]').focus();
		await page.keyboard.press('ArrowLeft');
		await expect.poll(text).toContain('size: [299, 58]');
		await form(page).getByLabel('Height').fill('52');
		await page.keyboard.press('Enter');
		await expect.poll(text).toContain('size: [299, 52]');

		// What is written in the file is drawn.
		const file = page.getByRole('region', { name: 'File', exact: true }).locator('.cm-content');
		await file.getByText('at: [25, 244]').click();
		await page.keyboard.press('End');
		for (let signs = 0; signs < 4; signs++) await page.keyboard.press('Backspace');
		await page.keyboard.type('240]');
		await expect(scene).toHaveAccessibleName('Planning scene: at 25, 240');
		await drawn(page, 'file');

		// A stop of the robot by itself.
		await thing(page, 'robot').focus();
		await page.keyboard.press('Enter');
		await expect(page.locator('[data-piece="stop:home"]')).toBeVisible();
		await page.keyboard.press('PageDown');
		await expect(page.locator('[data-piece="stop:home"]')).toBeFocused();
		await page.keyboard.press('ArrowUp');
		await expect.poll(text).toContain('home: {at: [174, 83], title: {en: Home, sv: Hemma}}');
		await expect(thing(page, 'robot')).toHaveAccessibleName('Robot UR10: at 658, 8');
		expect(complaints).toEqual([]);
	});

	test('is moved with a finger, once it is chosen', async ({ browse, drafting, complaints }) => {
		const before = (await drafting.files()).get(FILE) ?? '';
		const page = await browse(INA, at(FILE), { viewport: { width: 1024, height: 768 }, hasTouch: true });
		await drawn(page, 'file');
		const scene = thing(page, 'planning_scene');
		const touch = await page.context().newCDPSession(page);
		const swipe = async (dy: number): Promise<void> => {
			await scene.scrollIntoViewIfNeeded();
			const box = await scene.boundingBox();
			const [x, y] = [(box?.x ?? 0) + (box?.width ?? 0) / 2, (box?.y ?? 0) + (box?.height ?? 0) / 2];
			await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x, y }] });
			for (const part of [0.3, 0.6, 1]) await touch.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: [{ x, y: y + dy * part }] });
			await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
		};
		// Who goes down the page with a finger moves nothing, and chooses nothing.
		await swipe(-30);
		await expect(scene).toHaveAttribute('aria-pressed', 'false');
		await scene.tap();
		await expect(scene).toHaveAttribute('aria-pressed', 'true');
		expect((await drafting.files()).get(FILE)).toBe(before);
		await swipe(-30);
		await expect.poll(async () => (await drafting.files()).get(FILE)).not.toBe(before);
		expect(others(before, (await drafting.files()).get(FILE) ?? '')[0]).toEqual(['at: [24, 236]']);
		expect(complaints).toEqual([]);
	});

	test('gets and loses things, says what is not drawn, and can be begun anew', async ({ browse, drafting, complaints }) => {
		const text = async (): Promise<string | undefined> => (await drafting.files()).get(FILE);
		const page = await browse(INA, at(FILE));
		await drawn(page, 'file');
		await page.getByRole('button', { name: 'Add', exact: true }).click();
		await page.getByRole('list', { name: 'Add to the picture' }).getByRole('button', { name: 'Tank' }).click();
		await expect(thing(page, 'tank')).toBeVisible();
		await expect(form(page).getByRole('heading').first()).toContainText('tank');
		await form(page).getByLabel('Title in English').fill('Glue');
		await page.keyboard.press('Enter');
		await expect.poll(text).toContain('title: Glue');
		await form(page).getByLabel('Title in Swedish').fill('Lim');
		await page.keyboard.press('Tab');
		await expect.poll(text).toMatch(/en: Glue\n\s+sv: Lim|\{en: Glue, sv: Lim\}/);
		await form(page).locator('input[type="file"]').setInputFiles({
			name: 'glue tank.svg',
			mimeType: 'image/svg+xml',
			buffer: Buffer.from('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><rect width="20" height="20" fill="none" stroke="currentColor"/></svg>')
		});
		await expect.poll(text).toContain('drawing: drawings/glue_tank.svg');
		await expect(card(page).locator('[data-drawing="glue_tank.svg"] rect')).toHaveCount(1);
		await form(page).getByRole('button', { name: 'Duplicate' }).click();
		await expect(thing(page, 'tank_2')).toBeVisible();
		await form(page).getByRole('button', { name: 'To the back' }).click();
		await expect.poll(async () => /symbols:\s+(\w+):/.exec((await text()) ?? '')?.[1]).toBe('tank_2');
		await form(page).getByRole('button', { name: 'Delete', exact: true }).click();
		await expect(thing(page, 'tank_2')).toHaveCount(0);
		await undo(page).click();
		await expect(thing(page, 'tank_2')).toBeVisible();

		await drafting.change('A slip', [FILE, 'resource: nutrunner', 'resource: nutruner']);
		const slip = card(page).locator('xpath=..').getByRole('listitem').filter({ hasText: 'did you mean `nutrunner`?' });
		await slip.getByRole('button', { name: /^mimic\.yaml:\d+$/ }).click();
		await expect(form(page).getByRole('heading').first()).toContainText('nutrunner');
		await expect(form(page)).toContainText('did you mean `nutrunner`?', { timeout: 30_000 });
		await examine(page, 'picture');
		await page.setViewportSize({ width: 1440, height: 900 });

		// Without a file, what is made from the model; drawn from there, nothing moves.
		await page.goto(at(FILE));
		await page.getByRole('button', { name: 'Delete the drawing' }).click();
		await drawn(page, 'model');
		const stops = (): Promise<(string | null)[]> => card(page).locator('[data-stop], [data-part] circle').evaluateAll((all) => all.map((each) => `${each.getAttribute('cx')} ${each.getAttribute('cy')}`));
		const seen = await stops();
		expect(seen.length).toBeGreaterThan(5);
		await page.getByRole('button', { name: 'Draw the picture yourself' }).click();
		await drawn(page, 'file');
		expect(await stops()).toEqual(seen);
		expect((await text())?.split('\n').length).toBeLessThan(60);
		expect(complaints).toEqual([]);
	});
});

test.describe('a picture that is deployed', () => {
	test.use({ shared: null, byItself: false, devices: true, people: 'everybody', copied: 'bolt_tightening' });

	test('is on Operate as it was drawn', async ({ browse, drafting, complaints }) => {
		const page = await browse(ERIK, at(FILE));
		await drawn(page, 'file');
		await drag(page, thing(page, 'planning_scene'), [0, 40]);
		await expect(undo(page)).toBeEnabled();
		const placed = /planning_scene:\n\s+symbol: device\n\s+at: \[24, (\d+)\]/;
		await expect.poll(async () => placed.exec((await drafting.files()).get(FILE) ?? '')?.[1]).not.toBe('236');
		const y = Number(placed.exec((await drafting.files()).get(FILE) ?? '')?.[1]);
		const [, revision] = await Promise.all([drafting.checked(), drafting.save('Drawn')]);
		await page.goto('/');
		await takeControl(page);
		const deployed = page.evaluate(
			async ([id, number]) => {
				const headers = { 'Content-Type': 'application/json' };
				const body = JSON.stringify({ revision: id, number, reason: 'The picture' });
				return (await fetch('/api/v1/model/deployments', { method: 'POST', headers, body })).status;
			},
			[revision, await drafting.checked()] as const
		);
		expect(await deployed).toBe(204);
		const symbol = page.getByTestId('mimic').locator('[data-symbol="planning_scene"]');
		await expect(symbol).toHaveAttribute('y', String(y - 3), { timeout: 60_000 });
		expect(complaints.filter((each) => !/WebSocket|Failed to load/.test(each))).toEqual([]);
	});
});
