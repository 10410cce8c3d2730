/** Types of resources and their instances on the page *Model*. */
import type { Locator, Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { INA } from '../../station/station.ts';
import { expression, field, file, form, problems, write } from '../../station/editor.ts';
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
	await write(executing, 'target == stop and at != conveyor and att != stop');
	await page.keyboard.press('Escape');
	await expect(field(page, 'executing').locator('.cm-lintRange-error')).toHaveText('att');
	await write(executing, 'target == stop and at != stop');
	await page.keyboard.press('Escape');
	await expect(field(page, 'executing').locator('.cm-lintRange-error')).toHaveCount(0);
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
	await expect(problems(page).getByRole('status')).toHaveText(/^Checked/, { timeout: 60_000 });
	await expect(problems(page).getByRole('status')).not.toContainText('error');
	expect(await findings(page)).toEqual([]);

	// What an argument is wrong in is said beside it.
	await field(page, 'arguments').getByLabel('Arguments, conveyor').fill('outfeed');
	await field(page, 'arguments').getByLabel('Arguments, conveyor').press('Tab');
	await expect(field(page, 'arguments')).toContainText('is no value of');
	await page.getByRole('button', { name: /^Undo: / }).click();
	await expect(field(page, 'arguments')).not.toContainText('is no value of');
	expect(complaints).toEqual([]);
});
