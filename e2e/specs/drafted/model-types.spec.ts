/** Types of resources and their instances on the page *Model*. */
import type { Locator, Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { INA } from '../../station/station.ts';
import { check, expression, field, file, form, unfold, write } from '../../station/editor.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'robots drafted', byItself: false, people: 'everybody', copied: 'robots_with_buffer' });

const ROBOT = 'resources/robot_1.yaml';
const TYPE = 'types/robot.yaml';
const at = (...steps: string[]): string => `/model?${new URLSearchParams({ entry: steps.join('#') })}`;
const row = (page: Page, ...steps: string[]): Locator => page.locator(`[role="treeitem"][data-id="${steps.join('#')}"]`);
const dialog = (page: Page): Locator => page.getByRole('dialog');

test('an instance shows what it has of its type, changes it, and is reset; the type is written in with its own names', async ({
	browse,
	complaints
}) => {
	const page = await browse(INA, at(ROBOT, 'abilities', 'open_gripper'));
	await expect(row(page, ROBOT, 'abilities', 'open_gripper')).toContainText('of robot');
	await expect(form(page)).toContainText('From type robot');
	const title = field(page, 'title');
	await unfold(page, 'Name and time');
	await expect(title.locator('[data-typed]')).toHaveText('From type robot: Open the empty gripper');
	await title.getByRole('textbox').fill('Let go');
	await title.getByRole('textbox').press('Tab');
	await expect(title.locator('[data-typed="changed"]')).toContainText('Changed here. Type robot has: Open the empty gripper');
	await expect(file(page)).toContainText('title: Let go');
	await expect(row(page, ROBOT, 'abilities', 'open_gripper')).not.toContainText('of robot');
	expect(await findings(page)).toEqual([]);
	await title.getByRole('button', { name: 'Reset to the type’s: Title' }).click();
	await expect(title.locator('[data-typed="inherited"]')).toBeVisible();
	await expect(file(page)).not.toContainText('Let go');

	// The type: a parameter is a value there, and a wrong name is underlined behind it.
	await page.goto(at(TYPE, 'abilities', 'move_to'));
	const executing = expression(page, 'Executing');
	await unfold(page, 'Under way');
	await write(executing, 'target == stop and at != conveyor and att != stop');
	await page.keyboard.press('Escape');
	await expect(field(page, 'executing').locator('.cm-lintRange-error')).toHaveText('att');
	await write(executing, 'target == stop and at != stop');
	await page.keyboard.press('Escape');
	await expect(field(page, 'executing').locator('.cm-lintRange-error')).toHaveCount(0);
	await expect(file(page)).toContainText('executing: target == stop and at != stop');
	// Nothing of it is on its way any more when the page is left.
	await expect(field(page, 'executing').locator(':is([data-state="typing"], [data-state="sending"])')).toHaveCount(0);
	await expect(file(page)).toContainText('executing: target == stop and at != stop');

	// What both robots have is called otherwise for both, and the type with its file.
	await page.goto(at(TYPE, 'abilities', 'open_gripper'));
	await form(page).getByRole('button', { name: 'Rename…' }).click();
	await dialog(page).getByLabel('New name').fill('let_go');
	await dialog(page).getByRole('button', { name: 'Rename', exact: true }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('let_go');
	await page.goto(at(TYPE));
	await form(page).getByRole('button', { name: 'Rename…' }).click();
	await expect(dialog(page)).toContainText('It is named in 2 places');
	await dialog(page).getByLabel('New name').fill('arm');
	await dialog(page).getByRole('button', { name: 'Rename', exact: true }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('arm');
	await page.goto(at(ROBOT));
	await expect(field(page, 'type').getByRole('combobox')).toHaveValue('arm');
	await expect(check(page)).toHaveText('Checked', { timeout: 60_000 });
	expect(await findings(page)).toEqual([]);

	// What an argument is wrong in is said beside it.
	await field(page, 'arguments').getByLabel('Arguments, conveyor').fill('outfeed');
	await field(page, 'arguments').getByLabel('Arguments, conveyor').press('Tab');
	await expect(field(page, 'arguments')).toContainText('is no value of');
	await page.getByRole('button', { name: /^Undo: / }).click();
	await expect(field(page, 'arguments')).not.toContainText('is no value of');
	expect(complaints).toEqual([]);
});

test('the parameters of a type are written in its form, and all else of the file stays', async ({ browse, complaints }) => {
	const page = await browse(INA, at(TYPE));
	const parameters = field(page, 'parameters');
	const rows = parameters.getByRole('listitem');
	await expect(rows).toHaveCount(3);
	await expect(parameters.getByLabel('Kind of conveyor')).toHaveValue('value');
	await expect(parameters.getByLabel('Enumeration of conveyor')).toHaveValue('stops');
	await expect(parameters.getByLabel('Enumeration of namespace')).toHaveCount(0);

	await parameters.getByRole('button', { name: 'Add an entry: Parameters' }).click();
	const name = parameters.getByLabel('Parameters, name 4');
	await name.fill('stops');
	await name.press('Tab');
	await expect(parameters.getByText('The same name is here twice.')).toBeVisible();
	await name.fill('travel');
	await name.press('Tab');
	await expect(rows).toHaveCount(4);
	await parameters.getByLabel('Kind of travel').selectOption('number');
	await expect(file(page)).toContainText('travel: number');
	await parameters.getByLabel('Default of travel').fill('slow');
	await parameters.getByLabel('Default of travel').press('Tab');
	await expect(parameters.getByText('Write a number, such as 2.5.')).toBeVisible();
	await parameters.getByLabel('Default of travel').fill('2.5');
	await parameters.getByLabel('Default of travel').press('Tab');
	await expect(file(page)).toContainText('default: 2.5');
	await expect(file(page)).toContainText('stops: enumeration # where it can be sent');
	expect(await findings(page)).toEqual([]);

	await parameters.getByLabel('Kind of travel').selectOption('value');
	await expect(parameters.getByLabel('Enumeration of travel')).toHaveValue('stops');
	await parameters.getByRole('button', { name: 'Remove Parameters, travel' }).click();
	await expect(rows).toHaveCount(3);
	await expect(file(page)).not.toContainText('travel');
	await expect(file(page)).toContainText('stops: enumeration # where it can be sent');
	expect(complaints).toEqual([]);
});
