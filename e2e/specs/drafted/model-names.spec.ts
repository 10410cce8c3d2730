/** Sets, relations, maps and predicates on the page *Model*: made, edited, used, renamed and taken back. */
import type { Locator, Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { INA } from '../../station/station.ts';
import { check, expression, field, file, form, problems, write } from '../../station/editor.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const STATION = 'station.yaml';
const ROBOT = 'resources/robot.yaml';
const at = (...steps: string[]): string => `/model?${new URLSearchParams({ entry: steps.join('#') })}`;
/** What is written at a place of a field, by its label. */
const cell = (page: Page, name: string, label: string): Locator => field(page, name).locator(`input[aria-label="${label}"]`);
const dialog = (page: Page): Locator => page.getByRole('dialog');

async function add(page: Page, what: string, name: string, given: Readonly<Record<string, string>> = {}): Promise<void> {
	await form(page).getByRole('button', { name: 'Add…' }).click();
	await dialog(page).getByLabel('What').selectOption({ label: what });
	for (const [label, text] of Object.entries(given)) await dialog(page).getByLabel(label).fill(text);
	await dialog(page).getByLabel('Name', { exact: true }).fill(name);
	await dialog(page).getByRole('button', { name: 'Add', exact: true }).click();
	await expect(dialog(page)).toBeHidden();
	await expect(form(page).getByRole('heading').first()).toContainText(name);
}

/** What was typed last is in the draft, which was checked without an error. */
const sound = async (page: Page, typed: string): Promise<void> => {
	await expect(file(page)).toContainText(typed);
	await expect(check(page)).toHaveText('Checked', { timeout: 60_000 });
};

test('a set, a relation, a map and a predicate are made by forms, used in a guard, renamed and taken back', async ({
	browse,
	complaints
}) => {
	// The model is checked after each of its steps, beside other stations.
	test.setTimeout(240_000);
	const page = await browse(INA, at(STATION));
	await expect(form(page).getByRole('heading').first()).toBeVisible();

	await add(page, 'Set: Sets', 'at_engine', { Of: 'named_pose', 'Values, with commas between': 'above_engine, bolt_pair_1' });
	await expect(field(page, 'of').getByRole('combobox')).toHaveValue('named_pose');
	await field(page, 'values').getByRole('button', { name: 'Add an entry: Values' }).click();
	await expect(cell(page, 'values', 'Values, 3')).toBeFocused();
	await cell(page, 'values', 'Values, 3').fill('bolt_pair_22');
	await cell(page, 'values', 'Values, 3').press('Tab');
	// What is wrong is said at the field.
	await expect(field(page, 'values').getByRole('listitem').filter({ hasText: 'bolt_pair_22' }).last()).toContainText('bolt_pair_2');
	await cell(page, 'values', 'Values, 3').fill('bolt_pair_2');
	await cell(page, 'values', 'Values, 3').press('Tab');
	await sound(page, 'bolt_pair_2');

	await add(page, 'Relation: Relations', 'adjacent', {
		'First enumeration or set': 'pose',
		'Second enumeration or set': 'pose',
		'First pair: a value of the first': 'home',
		'First pair: a value of the second': 'above_engine'
	});
	await field(page, 'symmetric').getByRole('checkbox').check();
	await field(page, 'pairs').getByRole('button', { name: 'Add an entry: Pairs' }).click();
	await expect(cell(page, 'pairs', 'Pairs, name 2')).toBeFocused();
	await cell(page, 'pairs', 'Pairs, name 2').fill('above_engine');
	await cell(page, 'pairs', 'Pairs, value 2').fill('bolt_pair_1, bolt_pair_2');
	await cell(page, 'pairs', 'Pairs, value 2').press('Tab');
	await expect(file(page)).toContainText('symmetric: true');
	await expect(file(page)).toContainText('bolt_pair_2');
	expect(await findings(page)).toEqual([]);

	await add(page, 'Map: Maps', 'pose_of', { From: 'bolt_pair', To: 'pose' });
	// A row for each value; those that have none are missed, at the field.
	await expect(field(page, 'values').getByRole('combobox')).toHaveCount(3);
	await expect(form(page).getByRole('listitem').filter({ hasText: 'bolt_pair_3' }).last()).toBeVisible();
	await expect(problems(page)).toContainText('pose_of');
	for (const pair of ['bolt_pair_1', 'bolt_pair_2', 'bolt_pair_3']) {
		await cell(page, 'values', `Values, ${pair}`).fill(pair);
		await cell(page, 'values', `Values, ${pair}`).press('Tab');
	}
	await sound(page, 'bolt_pair_3: bolt_pair_3');
	expect(await findings(page)).toEqual([]);

	await page.goto(at(ROBOT));
	await expect(form(page).getByRole('heading').first()).toContainText('robot');
	await add(page, 'Predicate: Predicates of robot', 'can_go');
	await form(page).getByRole('button', { name: 'Add an entry: Parameters' }).click();
	await expect(cell(page, 'parameters', 'Parameters, name 1')).toBeFocused();
	await cell(page, 'parameters', 'Parameters, name 1').fill('to');
	await cell(page, 'parameters', 'Parameters, value 1').fill('named_pose');
	await cell(page, 'parameters', 'Parameters, value 1').press('Tab');
	await expect(file(page)).toContainText('to: named_pose');
	await write(expression(page, 'When'), 'pose in at_engine and adjacent(pose, to)');
	await page.keyboard.press('Escape');
	await sound(page, 'pose in at_engine and adjacent(pose, to)');

	// In a guard, with a wrong name first.
	await page.goto(at(ROBOT, 'abilities', 'move_to_previous'));
	const enabled = expression(page, 'Enabled');
	await expect(enabled).toContainText('moving');
	await write(enabled, 'can_goo(home) and pose == pose_of[bolt_pair_1] and pose in at_engine');
	await page.keyboard.press('Escape');
	await expect(field(page, 'enabled').locator('.cm-lintRange-error').first()).toHaveText(/can_goo/);
	await expect(field(page, 'enabled')).toContainText('did you mean `can_go`?');
	await write(enabled, 'can_go(home) and pose == pose_of[bolt_pair_1] and pose in at_engine');
	await page.keyboard.press('Escape');
	await expect(field(page, 'enabled').locator('.cm-lintRange-error')).toHaveCount(0);
	await expect(file(page)).toContainText('can_go(home)');
	await expect(check(page)).not.toContainText('error', { timeout: 60_000 });

	// What it is in the names it was written in, and what it stands for in the end.
	await expect(async () => {
		await page.mouse.move(0, 0);
		await enabled.getByText('can_go').hover({ position: { x: 20, y: 8 } });
		await expect(page.locator('.cm-tooltip-hover')).toContainText('Is pose in at_engine and adjacent(pose, home)', { timeout: 2000 });
	}).toPass();

	// Another name follows everywhere, and is taken back everywhere.
	await page.goto(at(STATION, 'sets', 'at_engine'));
	await form(page).getByRole('button', { name: 'Rename…' }).click();
	await expect(dialog(page)).toContainText('It is named in 2 places');
	await dialog(page).getByLabel('New name').fill('near_engine');
	await dialog(page).getByRole('button', { name: 'Rename', exact: true }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('near_engine');
	await page.goto(at(ROBOT, 'abilities', 'move_to_previous'));
	await expect(enabled).toContainText('pose in near_engine');
	await page.getByRole('button', { name: /^Undo: / }).click();
	await expect(enabled).toContainText('pose in at_engine');

	// Before it is taken out, it is said what would be wrong then.
	await page.goto(at(STATION, 'maps', 'pose_of'));
	await form(page).getByRole('button', { name: 'Delete…' }).click();
	await expect(dialog(page)).toContainText('1 place names it');
	await page.keyboard.press('Escape');
	expect(complaints).toEqual([]);
});

test('an enumeration comes to include others and to have an order', async ({ browse }) => {
	const page = await browse(INA, at(STATION, 'enumerations', 'request'));
	await form(page).getByRole('button', { name: 'Include others, or give it an order' }).click();
	await expect(field(page, 'values').getByRole('textbox').first()).toHaveValue('none');
	await field(page, 'ordered').getByRole('checkbox').check();
	await expect(file(page)).toContainText('ordered: true');
	await sound(page, 'ordered: true');
	await field(page, 'includes').getByRole('button', { name: 'Add an entry: Includes' }).click();
	await expect(cell(page, 'includes', 'Includes, 1')).toBeFocused();
	await cell(page, 'includes', 'Includes, 1').fill('bolt_par');
	await cell(page, 'includes', 'Includes, 1').press('Tab');
	await expect(field(page, 'includes')).toContainText('did you mean `bolt_pair`?');
});
