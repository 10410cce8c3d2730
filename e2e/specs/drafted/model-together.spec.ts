import type { Locator, Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { file, form } from '../../station/editor.ts';
import { INA, IVO, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const ROBOT = 'resources/robot.yaml';
const NUTRUNNER = 'resources/nutrunner.yaml';
const [POSITION, PREVIOUS, ATTACH, DETACH] = ['move_to_position', 'move_to_previous', 'attach_in_planning_scene', 'detach_in_planning_scene'] as const;
const at = (...steps: string[]): string => `/model?${new URLSearchParams({ entry: steps.join('#') })}`;
const row = (page: Page, ...steps: string[]): Locator => page.locator(`[role="treeitem"][data-id="${steps.join('#')}"]`);
const ability = (page: Page, name: string): Locator => row(page, ROBOT, 'abilities', name);
const heading = (page: Page): Locator => form(page).getByRole('heading').first();
const selected = (page: Page): Promise<string[]> =>
	page.locator('[role="treeitem"][aria-selected="true"] .name').allTextContents();
/** The abilities of the robot as they stand in the file. */
async function order(page: Page): Promise<string[]> {
	const answer = await page.context().request.get(`/api/v1/model/files?path=${ROBOT}`);
	const { files } = (await answer.json()) as { files: Record<string, { content: { abilities: object } }> };
	return Object.keys(files[ROBOT]?.content.abilities ?? {});
}
async function text(page: Page): Promise<string> {
	const answer = await page.context().request.get(`/api/v1/model/files?path=${ROBOT}`);
	return ((await answer.json()) as { files: Record<string, { text: string }> }).files[ROBOT]?.text ?? '';
}

/** Where a row is, once the tree has come to rest. */
async function rest(row: Locator): Promise<{ x: number; y: number; width: number; height: number }> {
	let box = await row.boundingBox();
	for (let before = null; box === null || box.y !== before; box = await row.boundingBox()) {
		before = box?.y ?? null;
		await row.page().waitForTimeout(200);
	}
	return box;
}

/** Takes hold of a row, and moves it over another one, so far down that. */
async function hold(page: Page, from: Locator, to: Locator, part: number): Promise<void> {
	const [a, b] = [await rest(from), await rest(to)];
	await page.mouse.move(a.x + a.width / 2, a.y + a.height / 2);
	await page.mouse.down();
	await page.mouse.move(b.x + b.width / 2, b.y + b.height * 0.5, { steps: 4 });
	await page.mouse.move(b.x + b.width / 2, b.y + b.height * part);
}

async function ready(page: Page, ...steps: string[]): Promise<void> {
	await expect(row(page, ...steps)).toBeVisible();
	await expect(heading(page)).toBeVisible();
	await row(page, ...steps).focus();
}

test('several parts are chosen by mouse and by keys, and what cannot be done with all of them is said', async ({ browse, complaints }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', POSITION));
	await ready(page, ROBOT, 'abilities', POSITION);
	await expect(page.getByRole('tree')).toHaveAttribute('aria-multiselectable', 'true');

	await ability(page, ATTACH).click({ modifiers: ['ControlOrMeta'] });
	await expect.poll(() => selected(page)).toEqual([POSITION, ATTACH]);
	await expect(page.getByRole('status').filter({ hasText: '2 parts selected' })).toBeVisible();
	await expect(heading(page)).toHaveText('2 parts selected');
	await ability(page, ATTACH).click({ modifiers: ['ControlOrMeta'] });
	await expect.poll(() => selected(page)).toEqual([POSITION]);
	await expect(heading(page)).toContainText(POSITION);
	await ability(page, DETACH).click({ modifiers: ['Shift'] });
	await expect.poll(() => selected(page)).toEqual([POSITION, PREVIOUS, ATTACH, DETACH]);
	expect(await findings(page)).toEqual([]);
	await page.keyboard.press('Escape');
	await expect.poll(() => selected(page)).toEqual([DETACH]);

	await page.keyboard.press('Shift+ArrowUp');
	await page.keyboard.press('Shift+ArrowUp');
	await expect.poll(() => selected(page)).toEqual([PREVIOUS, ATTACH, DETACH]);
	await page.keyboard.press('Shift+ArrowDown');
	await expect.poll(() => selected(page)).toEqual([ATTACH, DETACH]);
	await expect(ability(page, ATTACH)).toBeFocused();
	await page.keyboard.press('ControlOrMeta+a');
	await expect.poll(() => selected(page)).toEqual([POSITION, PREVIOUS, ATTACH, DETACH]);
	await page.keyboard.press('ControlOrMeta+Space');
	await expect.poll(() => selected(page)).toEqual([POSITION, PREVIOUS, DETACH]);

	// A part and what it is in: said, and what is left can be done.
	await row(page, ROBOT).click({ modifiers: ['ControlOrMeta'] });
	const hindered = form(page).locator('[data-hindered]').filter({ hasText: 'which is selected too' });
	await expect(hindered).toContainText('robot.move_to_position is in robot, which is selected too.');
	await expect(form(page).getByRole('button', { name: 'Delete…' })).toHaveAttribute('aria-disabled', 'true');
	await row(page, ROBOT).focus();
	await page.keyboard.press('Delete');
	await expect(page.getByRole('alert').filter({ hasText: 'which is selected too' })).toBeVisible();
	await expect(page.getByRole('dialog')).toHaveCount(0);
	expect(await findings(page)).toEqual([]);
	await hindered.getByRole('button', { name: 'Leave out 3, keep 1' }).first().click();
	await expect.poll(() => selected(page)).toEqual(['robot']);

	// A heading is no part.
	await row(page, ROBOT, 'abilities').click({ modifiers: ['ControlOrMeta'] });
	await expect(page.getByRole('alert').filter({ hasText: '“Abilities” is a heading' })).toBeVisible();
	await expect.poll(() => selected(page)).toEqual(['robot']);
	expect(complaints).toEqual([]);
});

test('several parts are duplicated, cut, pasted and deleted, each as one change', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', PREVIOUS));
	await ready(page, ROBOT, 'abilities', PREVIOUS);
	const before = await text(page);
	const undo = async (title: RegExp): Promise<void> => {
		await page.getByRole('button', { name: title }).first().click();
		await expect.poll(() => text(page)).toBe(before);
	};

	// Of one a name is asked for, and the copy is chosen.
	await page.keyboard.press('ControlOrMeta+d');
	await expect(page.getByRole('dialog').getByRole('textbox')).toBeFocused();
	await page.keyboard.press('Enter');
	await expect.poll(() => selected(page)).toEqual([`${PREVIOUS}_2`]);
	await undo(/^Undo: /);
	await ability(page, PREVIOUS).click();

	await ability(page, ATTACH).click({ modifiers: ['ControlOrMeta'] });
	await page.keyboard.press('ControlOrMeta+d');
	await expect.poll(() => order(page)).toEqual([POSITION, PREVIOUS, `${PREVIOUS}_2`, ATTACH, `${ATTACH}_2`, DETACH]);
	await expect.poll(() => selected(page)).toEqual([`${PREVIOUS}_2`, `${ATTACH}_2`]);
	await undo(/^Undo: 2 parts duplicated/);

	await ability(page, PREVIOUS).click();
	await ability(page, ATTACH).click({ modifiers: ['ControlOrMeta'] });
	await page.keyboard.press('ControlOrMeta+x');
	await expect.poll(() => order(page)).toEqual([POSITION, DETACH]);
	await row(page, NUTRUNNER).click();
	await page.keyboard.press('ControlOrMeta+v');
	await expect.poll(() => selected(page)).toEqual([PREVIOUS, ATTACH]);
	await expect(row(page, NUTRUNNER, 'abilities', ATTACH)).toHaveAttribute('aria-selected', 'true');
	await page.getByRole('button', { name: /^Undo: .* pasted/ }).first().click();
	await expect(row(page, NUTRUNNER, 'abilities', ATTACH)).toHaveCount(0);
	await undo(/^Undo: 2 parts cut/);

	// By the buttons of the form.
	await ability(page, ATTACH).click();
	await ability(page, DETACH).click({ modifiers: ['ControlOrMeta'] });
	await form(page).getByRole('button', { name: 'Copy', exact: true }).click();
	await expect(page.getByText(`${ATTACH}, ${DETACH} copied as YAML`)).toBeVisible();
	await form(page).getByRole('button', { name: 'Delete…' }).click();
	const dialog = page.getByRole('dialog');
	await expect(dialog.getByRole('heading')).toHaveText('Delete 2 parts');
	await expect(dialog).toContainText(/Nothing else names any of them|\d+ places? names? one of them/);
	expect(await findings(page)).toEqual([]);
	await dialog.getByRole('button', { name: 'Delete' }).click();
	await expect.poll(() => order(page)).toEqual([POSITION, PREVIOUS]);
	await expect(heading(page)).toContainText('Abilities');
	await undo(/^Undo: 2 parts deleted/);
});

test('siblings are put in another order by dragging; the line says where, and comments go along', async ({ browse, complaints }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', POSITION));
	await ready(page, ROBOT, 'abilities', POSITION);
	const before = await text(page);
	const drag = (from: Locator, to: Locator, part: number): Promise<void> => hold(page, from, to, part);

	await drag(ability(page, DETACH), ability(page, PREVIOUS), 0.2);
	await expect(ability(page, PREVIOUS)).toHaveAttribute('data-line', 'top');
	await page.mouse.up();
	await expect.poll(() => order(page)).toEqual([POSITION, DETACH, PREVIOUS, ATTACH]);
	await expect(page.getByRole('status').filter({ hasText: 'robot.detach_in_planning_scene moved: 2 of 4' })).toHaveCount(1);
	// Every line is there still.
	expect((await text(page)).split('\n').sort()).toEqual(before.split('\n').sort());
	await expect(heading(page)).toContainText(POSITION); // what is dragged is not chosen by that
	await page.getByRole('button', { name: /^Undo: robot.detach_in_planning_scene moved/ }).click();
	await expect.poll(() => text(page)).toBe(before);

	// All that are chosen go together.
	await ability(page, ATTACH).click({ modifiers: ['ControlOrMeta'] });
	await drag(ability(page, ATTACH), ability(page, DETACH), 0.8);
	await expect(ability(page, DETACH)).toHaveAttribute('data-line', 'bottom');
	await page.mouse.up();
	await expect.poll(() => order(page)).toEqual([PREVIOUS, DETACH, POSITION, ATTACH]);
	await page.getByRole('button', { name: /^Undo: 2 parts moved/ }).click();
	await expect.poll(() => text(page)).toBe(before);

	// Escape lets all be as it was; nothing is offered in another list.
	await ability(page, DETACH).click();
	await drag(ability(page, DETACH), ability(page, POSITION), 0.2);
	await expect(ability(page, POSITION)).toHaveAttribute('data-line', 'top');
	await page.keyboard.press('Escape');
	await expect(page.locator('[data-line]')).toHaveCount(0);
	await page.mouse.up();
	await drag(ability(page, DETACH), row(page, ROBOT), 0.5);
	await expect(page.locator('[data-line]')).toHaveCount(0);
	await page.mouse.up();
	expect(await text(page)).toBe(before);
	await drag(row(page, ROBOT), row(page, NUTRUNNER), 0.2);
	await page.mouse.up();
	await expect(page.getByRole('alert').filter({ hasText: 'files have no order' })).toBeVisible();
	expect(complaints).toEqual([]);
});

test('siblings are put in another order by keys, and what lies at the end stays there', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', PREVIOUS));
	await ready(page, ROBOT, 'abilities', PREVIOUS);
	const before = await text(page);
	await page.keyboard.press('Alt+ArrowDown');
	await page.keyboard.press('Alt+ArrowDown');
	await expect.poll(() => order(page)).toEqual([POSITION, ATTACH, DETACH, PREVIOUS]);
	await expect(ability(page, PREVIOUS)).toBeFocused();
	await expect(ability(page, PREVIOUS)).toHaveAttribute('aria-posinset', '4');
	await expect(page.getByRole('status').filter({ hasText: '4 of 4' })).toHaveCount(1);
	await page.keyboard.press('Alt+ArrowDown');
	await expect(page.getByRole('status').filter({ hasText: 'It is the last already' })).toHaveCount(1);
	await page.keyboard.press('Shift+ArrowUp');
	await page.keyboard.press('Alt+ArrowUp');
	await expect.poll(() => order(page)).toEqual([POSITION, DETACH, PREVIOUS, ATTACH]);
	await expect(file(page)).toContainText('move_to_previous');
	for (const _ of [1, 2, 3]) await page.keyboard.press('ControlOrMeta+z');
	await expect.poll(() => text(page)).toBe(before);
});

test('a connection that is lost in the midst of a drag loses nothing, and is said', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', POSITION));
	await ready(page, ROBOT, 'abilities', POSITION);
	await hold(page, ability(page, DETACH), ability(page, POSITION), 0.2);
	await expect(ability(page, POSITION)).toHaveAttribute('data-line', 'top');
	await page.context().setOffline(true);
	await page.mouse.up();
	const kept = page.getByRole('alert').filter({ hasText: 'Not written yet: robot.detach_in_planning_scene moved' });
	await expect(kept).toBeVisible({ timeout: 30_000 });
	await page.context().setOffline(false);
	await kept.getByRole('button', { name: 'Try again' }).click();
	await expect.poll(() => order(page)).toEqual([DETACH, POSITION, PREVIOUS, ATTACH]);
	await expect(kept).toBeHidden();
});

test('what somebody else deletes meanwhile is not moved, and who may not edit can look and copy @long', async ({ browse }) => {
	const [page, other] = await Promise.all([browse(INA, at(ROBOT, 'abilities', POSITION)), browse(IVO, at(ROBOT, 'abilities', DETACH))]);
	await Promise.all([ready(page, ROBOT, 'abilities', POSITION), ready(other, ROBOT, 'abilities', DETACH)]);
	await hold(page, ability(page, DETACH), ability(page, POSITION), 0.2);
	await expect(ability(page, POSITION)).toHaveAttribute('data-line', 'top');
	await other.keyboard.press('Delete');
	await other.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
	await expect(ability(page, DETACH)).toHaveCount(0);
	await page.mouse.up();
	await expect(page.getByRole('alert').filter({ hasText: 'somebody else has deleted or renamed it' })).toBeVisible();
	await expect.poll(() => order(page)).toEqual([POSITION, PREVIOUS, ATTACH]);

	const vera = await browse(VERA, at(ROBOT, 'abilities', POSITION));
	await ready(vera, ROBOT, 'abilities', POSITION);
	await vera.keyboard.press('Shift+ArrowDown');
	await expect(form(vera).getByRole('button', { name: 'Copy', exact: true })).toBeVisible();
	await expect(form(vera).getByRole('button', { name: 'Delete…' })).toHaveCount(0);
	await vera.keyboard.press('Alt+ArrowDown');
	await vera.keyboard.press('Delete');
	await expect(vera.getByRole('dialog')).toHaveCount(0);
	expect(await order(vera)).toEqual([POSITION, PREVIOUS, ATTACH]);
});
