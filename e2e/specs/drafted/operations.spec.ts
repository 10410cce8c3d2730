/** The page *Operations*: the order of the draft as a picture and as a table, drawn by mouse and by keyboard. */
import type { Locator, Page } from '@playwright/test';
import { examine } from '../../station/barriers.ts';
import { INA, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const FILE = 'operations.yaml';
const [PLACE_1, PLACE_2] = ['place_bolt_pair(bolt_pair_1)', 'place_bolt_pair(bolt_pair_2)'];
const box = (page: Page, name: string): Locator => page.locator(`[data-id="${name}"]`);
const arrow = (page: Page, before: string, after: string): Locator => page.locator(`.svelte-flow__edge[data-id="${before} → ${after}"]`);
const panel = (page: Page): Locator => page.getByRole('complementary', { name: 'The chosen operation' });
const after = (page: Page): Locator => panel(page).locator('section').filter({ has: page.getByRole('heading', { name: 'Comes after' }) });
const view = (page: Page, name: string): Locator => page.getByRole('group', { name: 'Shown as' }).getByRole('button', { name });

test('an order is drawn in the picture, said in the panel, taken back and taken out', async ({ browse, drafting, complaints }) => {
	const page = await browse(INA, '/operations');
	// What comes later is further to the right, in the lane of who does it.
	await expect(box(page, 'new_engine')).toBeVisible();
	const [first, second, last] = await Promise.all([PLACE_1, 'tighten_bolt_pair(bolt_pair_1)', 'new_engine'].map((name) => box(page, name).boundingBox()));
	expect(first!.x).toBeLessThan(second!.x);
	expect(second!.x).toBeLessThan(last!.x);
	await expect(arrow(page, PLACE_1, 'tighten_bolt_pair(bolt_pair_1)')).toBeAttached();
	await expect(arrow(page, PLACE_1, PLACE_2)).toHaveCount(0);

	const from = (await box(page, PLACE_1).locator('.svelte-flow__handle.source').boundingBox())!;
	const to = (await box(page, PLACE_2).locator('.svelte-flow__handle.target').boundingBox())!;
	await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
	await page.mouse.down();
	await page.mouse.move(to.x + to.width / 2, to.y + to.height / 2, { steps: 12 });
	await page.mouse.up();
	await expect(arrow(page, PLACE_1, PLACE_2)).toBeAttached();
	await expect.poll(async () => (await drafting.files()).get(FILE)).toContain('place_bolt_pair_then_place_bolt_pair:');
	await page.getByTestId('toasts').getByRole('button', { name: 'Take back' }).click();
	await expect(arrow(page, PLACE_1, PLACE_2)).toHaveCount(0);
	await expect.poll(async () => (await drafting.files()).get(FILE)).not.toContain('place_bolt_pair_then_place_bolt_pair:');

	// By keyboard, from what is said of an operation.
	await box(page, PLACE_2).press('Enter');
	await expect(panel(page).getByRole('heading', { level: 2 })).toHaveText('Place bolt pair 2');
	await expect(panel(page).locator('[data-holds="so"]')).toHaveText(/Bolt pair\s2 is empty/i);
	await panel(page).getByLabel('Let it come after').selectOption({ label: 'Place bolt pair 1' });
	await panel(page).getByRole('button', { name: 'Add', exact: true }).press('Enter');
	await expect(after(page).locator(`[data-link="${PLACE_1}"]`)).toContainText('sequence place_bolt_pair_then_place_bolt_pair', { ignoreCase: true });
	await after(page).getByRole('button', { name: /^Take out/ }).click();
	await expect(after(page).locator(`[data-link="${PLACE_1}"]`)).toHaveCount(0);
	// What a work master says is not taken out here, and what would be a circle is not offered.
	await box(page, 'tighten_bolt_pair(bolt_pair_2)').press('Enter');
	await expect(after(page).locator(`[data-link="${PLACE_2}"]`)).toContainText('work master “Truck engine”', { ignoreCase: true });
	await expect(after(page).getByRole('button', { name: /^Take out/ })).toHaveCount(0);
	await box(page, PLACE_2).press('Enter');
	await expect(panel(page).getByLabel('Let it come after').locator('option', { hasText: 'Tighten bolt pair 2' })).toHaveCount(0);
	expect(complaints).toEqual([]);
});

test('by keyboard one goes from box to box, to what is said of one, and back', async ({ browse, complaints }) => {
	const page = await browse(VERA, '/operations');
	await expect(box(page, 'new_engine')).toBeVisible();
	const picture = page.getByTestId('sequence');
	await expect(picture.locator('.svelte-flow__node[tabindex="0"]')).toHaveCount(1);
	await expect(page.getByRole('group', { name: 'Operations in their order' })).toHaveAccessibleDescription(/arrow keys/);
	await picture.locator('.svelte-flow__node[tabindex="0"]').focus();
	await page.keyboard.press('End');
	await expect(box(page, 'new_engine')).toBeFocused();
	await expect(panel(page).getByRole('heading', { level: 2 })).toHaveText('New engine');
	// To the left there is one of those that come before it; the choice goes along, the focus stays in the picture.
	await page.keyboard.press('ArrowLeft');
	await expect(picture.locator('.svelte-flow__node:focus')).toHaveAttribute('data-id', /^tighten_bolt_pair/);
	await expect(panel(page).getByRole('heading', { level: 2 })).toHaveText(/^Tighten bolt pair/);
	const at = (await picture.locator('.svelte-flow__node:focus').getAttribute('data-id'))!;
	await page.keyboard.press('ArrowDown');
	await page.keyboard.press('ArrowUp');
	await expect(box(page, at)).toBeFocused();
	await page.keyboard.press('Enter');
	await expect(panel(page).getByRole('heading', { level: 2 })).toBeFocused();
	await page.keyboard.press('Escape');
	await expect(box(page, at)).toBeFocused();
	await expect(panel(page)).toHaveCount(0);
	await page.keyboard.press('Home');
	await expect(box(page, PLACE_1)).toBeFocused();
	await expect(panel(page).getByRole('heading', { level: 2 })).toHaveText(/^Place bolt pair/);
	await page.keyboard.press('Escape');
	await expect(panel(page)).toHaveCount(0);
	await expect(box(page, PLACE_1)).toBeFocused();
	// The help says so.
	await page.keyboard.press('?');
	await expect(page.getByRole('dialog')).toContainText('arrow keys lead from one to the next');
	await page.keyboard.press('Escape');
	expect(complaints).toEqual([]);
});

test('several are picked and put together, by mouse and by keyboard; what cannot be is refused with the reason', async ({ browse, drafting, complaints }) => {
	const page = await browse(INA, '/operations');
	await expect(box(page, 'new_engine')).toBeVisible();
	const bar = page.getByRole('toolbar', { name: 'Put them together' });
	const before = (await drafting.files()).get(FILE)!;
	// By mouse: the chosen one goes with those that are picked.
	await box(page, PLACE_2).click();
	await box(page, PLACE_1).click({ modifiers: ['Shift'] });
	await expect(bar.getByRole('status')).toContainText('2 picked: Place bolt pair 2, Place bolt pair 1');
	await bar.getByRole('button', { name: 'Any order' }).click();
	await expect.poll(async () => (await drafting.files()).get(FILE)).toBe(`${before.trimEnd()}\n\nplace_bolt_pair_and_place_bolt_pair:\n  arbitrary: [${PLACE_2}, ${PLACE_1}]\n`);
	await expect(bar).toHaveCount(0);
	await expect(page.locator('[data-group="arbitrary"]').first()).toContainText('Any order');
	await expect(panel(page).getByRole('heading', { name: 'Together with others' })).toBeVisible();
	await expect(panel(page).locator('[data-group="arbitrary"]')).toContainText('Any order: Place bolt pair 2, Place bolt pair 1');
	// The same once more, or only one of them, is refused.
	await box(page, PLACE_1).click({ modifiers: ['Shift'] });
	await bar.getByRole('button', { name: 'One of them' }).click();
	await expect(page.getByRole('alert').filter({ hasText: 'put together already, in “place_bolt_pair_and_place_bolt_pair”: Any order' })).toBeVisible();
	await bar.getByRole('button', { name: 'Pick none' }).click();
	await page.getByRole('button', { name: /^Undo/ }).click();
	await expect.poll(async () => (await drafting.files()).get(FILE)).toBe(before);

	// By keyboard; one that waits for another cannot be done at once with it.
	await page.keyboard.press('Escape');
	await box(page, PLACE_1).focus();
	await page.keyboard.press('Escape');
	// Nothing is chosen any more, which would go with what is picked.
	await expect(page).not.toHaveURL(/operation=/);
	await page.keyboard.press('Shift+Space');
	await expect(bar.getByRole('status')).toContainText('One picked');
	await box(page, 'tighten_bolt_pair(bolt_pair_1)').focus();
	await page.keyboard.press('Shift+Space');
	await bar.getByRole('button', { name: 'At once' }).press('Enter');
	await expect(page.getByRole('alert').filter({ hasText: '“Tighten bolt pair 1” waits for “Place bolt pair 1” already' })).toBeVisible();
	await box(page, PLACE_1).focus();
	await page.keyboard.press('Escape');
	await expect(bar).toHaveCount(0);
	expect((await drafting.files()).get(FILE)).toBe(before);
	await examine(page, 'operations');
	expect(complaints).toEqual([]);
});

test('what is of the station that runs is told apart from the draft, where the two differ', async ({ browse, drafting, complaints }) => {
	const page = await browse(INA, `/operations?operation=${encodeURIComponent('tighten_bolt_pair(bolt_pair_1)')}`);
	const begins = panel(page).getByRole('heading', { name: /^Begins when/ });
	await expect(panel(page).locator('[data-holds]').first()).toBeVisible();
	await expect(panel(page).getByTestId('station-now')).toHaveCount(0);
	await drafting.change('Begins earlier', [FILE, 'precondition: bolts[pair] == placed', 'precondition: bolts[pair] != tightened']);
	await expect(panel(page).getByTestId('station-now')).toHaveText('station now');
	await expect(begins).toHaveText('Begins when draft');
	expect(complaints).toEqual([]);
});

test('a draft that cannot be used leaves the order in sight; the table says the same; nobody is kept from it', async ({ browse, drafting, complaints }) => {
	const page = await browse(VERA, '/operations?operation=new_engine');
	await expect(after(page).getByRole('listitem')).toHaveCount(3);
	await expect(panel(page).getByLabel('Let it come after')).toHaveCount(0);
	await drafting.change('An operation that means nothing', [FILE, 'goal: bolts[pair] == tightened', 'goal: bolts[pair] == tightned']);
	await expect(page.getByRole('alert').filter({ hasText: 'The draft cannot be used as it is' })).toBeVisible();
	await expect(box(page, 'new_engine')).toBeVisible();
	await drafting.change('Mended', [FILE, 'goal: bolts[pair] == tightned', 'goal: bolts[pair] == tightened']);
	await expect(page.getByRole('alert').filter({ hasText: 'The draft cannot be used' })).toHaveCount(0);

	await view(page, 'Table').click();
	const table = page.getByTestId('operations-table');
	await expect(table.getByRole('row').filter({ hasText: 'New engine' })).toContainText('Tighten bolt pair 1, Tighten bolt pair 2, Tighten bolt pair 3');
	await table.getByRole('button', { name: 'Prepare the planning scene' }).click();
	await expect(page).toHaveURL(/operation=prepare_planning_scene/);
	await view(page, 'Gantt').click();
	await expect(page.getByTestId('operations-time').or(page.getByText('Nothing is under way'))).toBeVisible();
	await view(page, 'Sequence').click();
	await examine(page, 'operations');
	expect(complaints).toEqual([]);
});
