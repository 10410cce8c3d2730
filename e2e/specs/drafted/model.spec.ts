import type { Locator, Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { picture } from '../../station/seen.ts';
import { check, expression, field, file, form, panel, problems, write } from '../../station/editor.ts';
import { INA, IVO, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const ROBOT = 'resources/robot.yaml';
const at = (...steps: string[]): string => `/model?${new URLSearchParams({ entry: steps.join('#') })}`;
const row = (page: Page, ...steps: string[]): Locator => page.locator(`[role="treeitem"][data-id="${steps.join('#')}"]`);
const changes = (page: Page): Locator => page.getByRole('region', { name: 'Last changes' });
const dialog = (page: Page): Locator => page.getByRole('dialog');

async function ready(page: Page): Promise<void> {
	await expect(page.getByRole('tree')).toBeVisible();
	await expect(form(page).getByRole('heading').first()).toBeVisible();
}

/** Adds a part by its dialog. */
async function add(page: Page, kind: string, name: string): Promise<void> {
	await form(page).getByRole('button', { name: 'Add…' }).click();
	await dialog(page).getByLabel('What').selectOption({ label: kind });
	await dialog(page).getByLabel('Name').fill(name);
	await dialog(page).getByRole('button', { name: 'Add', exact: true }).click();
	await expect(dialog(page)).toBeHidden();
	await expect(form(page).getByRole('heading').first()).toContainText(name);
}

test('a variable and an ability with guard and action are added; what is wrong is underlined, found, put right, undone', async ({
	browse,
	complaints
}) => {
	const page = await browse(INA, at(ROBOT));
	await ready(page);
	await add(page, 'Variable: Estimated variables of robot', 'is_checked');
	await expect(row(page, ROBOT, 'estimated', 'is_checked')).toHaveAttribute('aria-selected', 'true');
	await expect(file(page)).toContainText('is_checked');
	await expect(row(page, ROBOT).locator('[data-changed="changed"]')).toBeVisible();

	// What was added is taken back: what it was in is chosen then, and not what is there no more.
	await page.getByRole('button', { name: /^Undo: / }).click();
	await expect(row(page, ROBOT, 'estimated', 'is_checked')).toHaveCount(0);
	await expect(form(page).getByRole('heading').first()).toBeVisible();
	await expect(form(page)).not.toContainText('There is no such part any more');
	await page.getByRole('button', { name: /^Redo: / }).click();
	await row(page, ROBOT, 'estimated', 'is_checked').click();
	await expect(form(page).getByRole('heading').first()).toContainText('is_checked');

	await add(page, 'Ability: Abilities of robot', 'check_pose');
	await expect(expression(page, 'Enabled')).toHaveText('false'); // what is new has come into the field
	await write(expression(page, 'Enabled'), 'pose == home and not is_chekced');
	await expect(field(page, 'enabled')).toContainText('did you mean `is_checked`?');
	await expect(field(page, 'enabled').locator('.cm-lintRange-error')).toHaveText('is_chekced');
	await expect(expression(page, 'Enabled')).toHaveAttribute('aria-invalid', 'true');
	await expect(expression(page, 'Enabled')).toHaveAccessibleDescription(/did you mean/);
	await expect(field(page, 'enabled').locator('[data-state="accepted"]')).toBeVisible();
	await expect(check(page)).toHaveText('Cannot be used: 1 error');
	await expect(problems(page).locator('[data-finding]')).toContainText('did you mean `is_checked`?');
	await expect(row(page, ROBOT, 'abilities', 'check_pose')).toContainText('1 error');
	expect(await findings(page)).toEqual([]);
	await page.emulateMedia({ colorScheme: 'dark' });
	expect(await findings(page, ['color-contrast'])).toEqual([]);
	await page.emulateMedia({ colorScheme: 'light' });

	// A finding leads to the entry, and to its line in the file.
	await row(page, ROBOT, 'abilities', 'check_pose').focus();
	await page.keyboard.press('Home');
	await page.keyboard.press('Enter');
	await expect(form(page).getByRole('heading').first()).toContainText('Station');
	await problems(page).getByRole('button', { name: /^resources\/robot\.yaml:\d+$/ }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('check_pose');
	await expect(file(page).locator('.cm-chosen').first()).toContainText('check_pose');

	// What was meant is written by a press, and that is one step of undo.
	await problems(page).getByRole('button', { name: 'Write “is_checked”' }).click();
	await expect(expression(page, 'Enabled')).toHaveText('pose == home and not is_checked');
	await expect(page.getByRole('button', { name: 'Undo: “is_chekced” becomes “is_checked”' })).toBeVisible();
	await expect(field(page, 'enabled').locator('.cm-lintRange-error')).toHaveCount(0);
	await form(page).getByRole('button', { name: 'Add an entry: Start: Actions' }).click();
	await write(expression(page, 'Start: Actions, 1'), 'is_checked := true');
	await expect(file(page)).toContainText('is_checked := true');
	await expect(check(page)).toHaveText('Checked', { timeout: 60_000 });

	await panel(page, 'Changes');
	await expect(changes(page).getByRole('listitem').first()).toContainText('robot.check_pose: Start: Actions');
	await expect(changes(page).getByRole('listitem').first()).toContainText('Ina');
	// From what to what, with its place.
	await expect(changes(page).getByRole('listitem').first().locator('[data-place]')).toContainText('is_checked := true');
	await expect(page.getByRole('button', { name: 'Undo: robot.check_pose: Start: Actions' })).toBeVisible();
	await panel(page, 'Problems');
	await problems(page).getByRole('heading', { name: 'Problems' }).focus();
	await page.keyboard.press('Control+z');
	await expect(file(page)).not.toContainText('is_checked := true');
	await expect(expression(page, 'Start: Actions, 1')).toHaveCount(0);
	await page.keyboard.press('Control+Shift+Z');
	await expect(file(page)).toContainText('is_checked := true');
	await expect(expression(page, 'Start: Actions, 1')).toHaveText('is_checked := true');
	await picture(page, 'model');
	expect(complaints).toEqual([]);
});

test('names are completed and explained, and a condition is formatted, by keyboard @long', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', 'move_to_previous'));
	await ready(page);
	const enabled = expression(page, 'Enabled');
	await write(enabled, 'prev');
	await expect(page.locator('.cm-tooltip-autocomplete [aria-selected="true"]')).toContainText('previous_pose');
	// A list that has only just come up is not taken from, or who types on would take what they have not seen.
	await page.waitForTimeout(200);
	await page.keyboard.press('Enter');
	await expect(enabled).toHaveText('previous_pose');
	await page.keyboard.type('==home  and(not moving)');
	await page.keyboard.press('Escape');
	await page.keyboard.press('Shift+Alt+F');
	await expect(enabled).toHaveText('previous_pose == home and not moving');
	// What the pointer rests on is explained; while the check comes back it may have to come again.
	await expect(async () => {
		await page.mouse.move(0, 0);
		await enabled.getByText('previous_pose').hover({ position: { x: 20, y: 8 } });
		await expect(page.locator('.cm-tooltip-hover')).toContainText('Measured variable', { timeout: 2000 });
	}).toPass();
	await expect(page.locator('.cm-tooltip-hover')).toContainText('bolt_pair_1');
});

test('what is written in the file is in the form, with its comments, and the form follows @long', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT));
	await ready(page);
	await expect(field(page, 'title').getByRole('textbox')).toHaveValue('Robot UR10');
	const line = file(page).getByText('title: Robot UR10');
	await line.click();
	await page.keyboard.press('End');
	await page.keyboard.type(' there # by hand');
	await expect(field(page, 'title').getByRole('textbox')).toHaveValue('Robot UR10 there');
	await field(page, 'title').getByRole('textbox').fill('Back');
	await expect(file(page)).toContainText('title: Back # by hand');

	// Where the cursor is put is what is chosen.
	await file(page).getByText('/ur10/state:', { exact: true }).first().click();
	await expect(form(page).getByRole('heading').first()).toContainText('/ur10/state');

	// What cannot be read is said, and nothing of the form is lost with it.
	await page.keyboard.press('End');
	await page.keyboard.type(' [');
	await expect(form(page).getByRole('alert').filter({ hasText: 'cannot be read' })).toContainText('The file cannot be read, line');
	await expect(field(page, 'type').locator('input')).toHaveAttribute('readonly');
	await page.keyboard.press('Backspace');
	await expect(field(page, 'type').locator('input')).not.toHaveAttribute('readonly');
});

test('two engineers at once: the form follows, and where both write the same both versions are shown @long', async ({ browse }) => {
	const address = at(ROBOT);
	const [ina, ivo] = await Promise.all([browse(INA, address), browse(IVO, address)]);
	await Promise.all([ready(ina), ready(ivo)]);
	const title = (page: Page): Locator => field(page, 'title').getByRole('textbox');

	await title(ina).fill('Ina was here');
	await title(ina).press('Tab');
	await expect(title(ivo)).toHaveValue('Ina was here', { timeout: 2000 });
	await panel(ivo, 'Changes');
	await expect(changes(ivo).getByRole('listitem').first()).toContainText('Ina');

	// Ivo is still writing when Ina has written.
	await ivo.route('**/api/v1/model/changes', async (route) => {
		await new Promise((resolve) => setTimeout(resolve, 2500));
		await route.continue();
	});
	await title(ivo).fill('Ivo was here');
	await title(ivo).press('Tab');
	await title(ina).fill('Ina again');
	await title(ina).press('Tab');
	const choice = ivo.getByRole('alertdialog');
	await expect(choice).toContainText('Ivo was here');
	await expect(choice).toContainText('Ina again');
	await expect(title(ivo)).toHaveValue('Ivo was here');
	expect(await findings(ivo)).toEqual([]);
	await ivo.unroute('**/api/v1/model/changes');
	await choice.getByRole('button', { name: 'Write mine' }).click();
	await expect(choice).toBeHidden();
	await expect(title(ina)).toHaveValue('Ivo was here');

	// Different lines of one file bear both.
	await file(ivo).getByText('topics:', { exact: true }).first().click();
	await ivo.keyboard.press('End');
	await ivo.keyboard.type(' # Ivo');
	await title(ina).fill('Ina at last');
	await expect(file(ina)).toContainText('topics: # Ivo');
	await expect(file(ivo)).toContainText('title: Ina at last');
});

test('what was typed and not written is kept, said, and found again', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT));
	await ready(page);
	await page.route('**/api/v1/model/changes', (route) => route.abort());
	const title = field(page, 'title').getByRole('textbox');
	await title.fill('Kept');
	await expect(field(page, 'title').getByRole('button', { name: 'Try again' })).toBeVisible();
	await row(page, 'resources/nutrunner.yaml').click();
	const back = page.getByRole('button', { name: /^Go to robot\b/ });
	await expect(back).toBeVisible(); // it was sent once more as its field went out of sight
	await page.unroute('**/api/v1/model/changes');
	await back.click();
	await expect(form(page).getByRole('heading', { name: 'robot' })).toBeVisible();
	await expect(title).toContainText('Kept');
	await form(page).getByRole('button', { name: 'Try again' }).click();
	await expect(file(page)).toContainText('title: Kept');
	await expect(page.getByText('Not written yet')).toBeHidden();
});

test('dialogs refuse bad names with why, and do what they say', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', 'attach_in_planning_scene'));
	await ready(page);
	const refuses = async (bad: readonly [string, string][], label: string, word: string): Promise<void> => {
		for (const [name, why] of bad) {
			await dialog(page).getByLabel(label).fill(name);
			await expect(dialog(page).getByRole('alert').filter({ hasText: why })).toBeVisible();
			await expect(dialog(page).getByRole('button', { name: word, exact: true })).toHaveAttribute('aria-disabled', 'true');
			await page.keyboard.press('Enter');
			await expect(dialog(page)).toBeVisible();
		}
	};
	const BAD: [string, string][] = [
		['2nd', 'begins with no digit'],
		['two words', 'letters from A to Z'],
		['and', 'word of the language'],
		['move_to_previous', 'already'],
		['', 'Write a name']
	];
	await form(page).getByRole('button', { name: 'Add…' }).click();
	await refuses(BAD, 'Name', 'Add');
	expect(await findings(page)).toEqual([]);
	await page.keyboard.press('Escape');
	await form(page).getByRole('button', { name: 'Duplicate…' }).click();
	await refuses(BAD, 'Name of the copy', 'Duplicate');
	await dialog(page).getByLabel('Name of the copy').fill('attach_again');
	await page.keyboard.press('Enter');
	await expect(row(page, ROBOT, 'abilities', 'attach_again')).toHaveAttribute('aria-selected', 'true');

	await form(page).getByRole('button', { name: 'Move up' }).click();
	await expect(row(page, ROBOT, 'abilities', 'attach_again')).toHaveAttribute('aria-posinset', '3');

	await form(page).getByRole('button', { name: 'Delete…' }).click();
	await dialog(page).getByRole('button', { name: 'Delete' }).click();
	await expect(row(page, ROBOT, 'abilities', 'attach_again')).toHaveCount(0);
	await expect(form(page).getByRole('heading').first()).toContainText('Abilities');
});

test('a renamed variable is renamed wherever it is named; before it is deleted it is said what names it @long', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'measured', 'pose'));
	await ready(page);
	await form(page).getByRole('button', { name: 'Rename…' }).click();
	await expect(dialog(page)).toContainText(/It is named in \d+ places/);
	await dialog(page).getByLabel('New name').fill('previous_pose');
	await expect(dialog(page).getByRole('alert').filter({ hasText: 'already' })).toBeVisible();
	await dialog(page).getByLabel('New name').fill('place');
	await dialog(page).getByRole('button', { name: 'Rename', exact: true }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('place');
	await expect(file(page)).toContainText('target_pose == place and place != position');
	await page.goto('/model');
	await expect(expression(page, 'States of rest')).toContainText('robot.place == home');

	await page.goto(at(ROBOT, 'measured', 'place'));
	await form(page).getByRole('button', { name: 'Delete…' }).click();
	await expect(dialog(page)).toContainText(/places? names? it, and will be wrong without it/);
	await page.keyboard.press('Escape');
});

test('a part is copied in the tree and pasted into another resource; what is none is said, and one undo takes it back', async ({ browse }) => {
	const page = await browse(INA, at(ROBOT, 'abilities', 'move_to_position'));
	await ready(page);
	const [from, to, copy] = [row(page, ROBOT, 'abilities', 'move_to_position'), row(page, 'resources/nutrunner.yaml'), row(page, 'resources/nutrunner.yaml', 'abilities', 'move_to_position')];
	await from.focus();
	await expect(async () => {
		await page.keyboard.press('Control+c');
		await expect(page.getByText('move_to_position copied as YAML')).toBeVisible({ timeout: 1000 });
	}).toPass();
	await to.click();
	await to.focus();
	await page.keyboard.press('Control+v');
	await expect(copy).toHaveAttribute('aria-selected', 'true');
	await expect(form(page).getByRole('heading').first()).toContainText('move_to_position');
	await expect(file(page)).toContainText('move_to_position');
	await page.getByRole('button', { name: /^Undo/ }).first().click();
	await expect(copy).toHaveCount(0);

	// What stands in the clipboard may be anything.
	await to.focus();
	for (const [text, said] of [['hello', 'no part of a model'], ['nonsense: {a: {}}', '“nonsense” has no place here']] as const) {
		await to.evaluate((element, pasted) => {
			const clipboardData = new DataTransfer();
			clipboardData.setData('text/plain', pasted);
			element.dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true }));
		}, text);
		await expect(page.getByRole('alert').filter({ hasText: said })).toBeVisible();
	}
	await expect(copy).toHaveCount(0);
});

test('the tree is gone through by keyboard and searched; who may not edit can look @long', async ({ browse }) => {
	const page = await browse(VERA, '/model');
	await ready(page);
	await expect(page.getByText('To change it the role engineer is needed')).toBeVisible();
	await expect(form(page).getByRole('button', { name: 'Add…' })).toHaveCount(0);
	await expect(expression(page, 'States of rest')).toHaveAttribute('aria-readonly', 'true');

	await row(page, 'station.yaml').focus();
	await page.keyboard.press('End');
	await expect(row(page, '', 'messages')).toBeFocused();
	await page.keyboard.press('Home');
	await page.keyboard.type('res');
	await expect(row(page, '', 'resources')).toBeFocused();
	await page.keyboard.press('ArrowRight');
	await expect(row(page, 'resources/engine.yaml')).toBeFocused();
	await page.keyboard.press('ArrowRight');
	await expect(row(page, 'resources/engine.yaml')).toHaveAttribute('aria-expanded', 'true');
	await page.keyboard.press('ArrowLeft');
	await page.keyboard.press('ArrowLeft');
	await expect(row(page, '', 'resources')).toBeFocused();
	await page.keyboard.press('ArrowDown');
	await page.keyboard.press('Enter');
	await expect(form(page).getByRole('heading').first()).toContainText('engine');
	await page.getByLabel('Search: name or title').fill('tighten');
	await expect(page.getByRole('treeitem').filter({ hasText: 'tighten_bolt_pair' })).toBeVisible();
	await expect(page.getByRole('treeitem').filter({ hasText: 'robot' })).toHaveCount(0);
});

test('what could be said shorter is found, proven, written under a name that is given, and taken back', async ({
	browse,
	complaints
}) => {
	const page = await browse(INA, at('operations.yaml', 'new_engine'));
	await ready(page);
	const shorter = page.getByRole('region', { name: 'Shorter with the same meaning' });
	await panel(page, 'Could be shorter');
	await shorter.getByRole('button', { name: 'Look for shorter ways' }).click();
	const predicate = shorter.getByRole('listitem').filter({ hasText: 'Name a predicate `all_tightened`' });
	await expect(predicate.getByLabel('Name')).toHaveValue('all_tightened', { timeout: 60_000 });
	await expect(shorter.getByRole('status').first()).toContainText('ways found');
	await expect(shorter).toContainText('any pair in bolt_pair: bolts[pair] == placed');
	expect(await findings(page)).toEqual([]);

	// Each place leads to where it is written.
	await predicate.getByRole('button', { name: /^resources\/engine\.yaml:\d+$/ }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('next_engine');
	await expect(file(page).locator('.cm-chosen').filter({ hasText: 'bolts[bolt_pair_1] == tightened' })).toBeVisible();

	// A name that means something else is refused, and nothing is written.
	await predicate.getByLabel('Name').fill('bolts');
	await predicate.getByRole('button', { name: 'Write it so' }).click();
	await expect(shorter.getByRole('alert')).toContainText('is the name of something else');
	await predicate.getByLabel('Name').fill('is_done');
	await predicate.getByRole('button', { name: 'Write it so' }).click();
	await panel(page, 'Changes');
	await expect(changes(page).getByRole('listitem').first()).toContainText('Name a predicate `is_done`, in 2 places', {
		timeout: 60_000
	});
	await expect(file(page)).toContainText('is_done');
	await expect(file(page)).not.toContainText('bolts[bolt_pair_1] == tightened');
	await panel(page, 'Problems');
	await expect(check(page)).toHaveText('Checked', { timeout: 60_000 });
	await panel(page, 'Could be shorter');
	await expect(predicate).toHaveCount(0, { timeout: 60_000 });

	// All of it is one change.
	await page.getByRole('button', { name: /^Undo: Name a predicate `is_done`/ }).click();
	await expect(file(page)).toContainText('bolts[bolt_pair_1] == tightened');
	await expect(shorter.getByRole('status').first()).toContainText('look again');
	expect(complaints.filter((each) => !each.includes('422'))).toEqual([]);
});
