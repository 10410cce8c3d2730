import type { Locator, Page } from '@playwright/test';
import { examine, findings } from '../../station/barriers.ts';
import { VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const map = (page: Page): Locator => page.getByRole('group', { name: 'Map of the station' });
const piece = (page: Page, id: string): Locator => page.locator(`[data-stop="${id}"]`);
const chosen = (page: Page): Locator => page.getByRole('complementary', { name: 'What is chosen' });
const above = (page: Page): Locator => chosen(page).getByRole('region', { name: /^Above/ });
const below = (page: Page): Locator => chosen(page).getByRole('region', { name: /^Below/ });

test('from the goal of an operation down to the topic that carries it out, by mouse and by keyboard @long', async ({
	browse,
	complaints
}) => {
	const page = await browse(VERA, '/model?view=graph');
	await expect(map(page).getByRole('heading', { level: 2 })).toHaveText([/^Layer 3/, /^Layer 2/, /^Layer 1/, /^Layer 0/]);
	await expect(map(page).locator('[data-layer="1"]').locator('[data-stop="ability:nutrunner.run_nut"]')).toBeVisible();
	await piece(page, 'operation:prepare_planning_scene').click();
	await expect(page).toHaveURL(/thing=operation/);
	await expect(below(page).locator('[data-manner="goal"]')).toContainText('robot.tool_is_attached');
	await expect(below(page).locator('[data-manner="goal"]').getByRole('link')).toHaveText([/^operations\.yaml:\d+$/]);
	await expect(piece(page, 'variable:robot.tool_is_attached')).toHaveAttribute('data-tied', 'near');
	for (const far of ['ability:robot.attach_in_planning_scene', 'variable:robot.attach_tool', 'topic:/ur10/planning_scene/command'])
		await expect(piece(page, far)).toHaveAttribute('data-tied', 'far');
	await expect(piece(page, 'ability:nutrunner.run_nut')).toHaveAttribute('data-tied', 'not');
	await examine(page, 'station');
	await page.setViewportSize({ width: 1440, height: 900 });

	// By keyboard: the map is one stop, arrows go through it as it is seen, and what is chosen stays.
	await piece(page, 'operation:prepare_planning_scene').focus();
	await page.keyboard.press('ArrowLeft');
	await expect(piece(page, 'operation:new_engine')).toBeFocused();
	await page.keyboard.press('ArrowDown');
	await expect(piece(page, 'operation:prepare_planning_scene')).toBeFocused();
	await page.keyboard.press('ArrowDown');
	await expect(piece(page, 'specification:no_standing_tool_on_placed_bolts')).toBeFocused();
	await page.keyboard.press('ArrowUp');
	await page.keyboard.press('Home');
	await expect(map(page).locator('[data-stop]').first()).toBeFocused();
	await page.keyboard.press('ArrowRight');
	await page.keyboard.press('Enter');
	await expect(chosen(page).getByRole('heading', { level: 2 })).toContainText('truck_engine');
	await expect(below(page).locator('[data-manner="runs"]')).toContainText('tighten_bolt_pair');
	await below(page).locator('[data-manner="runs"]').getByRole('button', { name: /new_engine/ }).press('Enter');
	await expect(chosen(page).getByRole('heading', { level: 2 })).toBeFocused();
	await expect(chosen(page).getByRole('heading', { level: 2 })).toContainText('new_engine');
	await piece(page, 'operation:new_engine').press('Escape');
	await expect(chosen(page)).toBeHidden();

	// The tree and the graph go together, and from there it is a step to the form and back.
	await page.locator('[role="treeitem"][data-id="operations.yaml#new_engine"]').click();
	await expect(chosen(page).getByRole('heading', { level: 2 })).toContainText('new_engine');
	await chosen(page).getByRole('link', { name: 'Open' }).click();
	await expect(page.getByRole('region', { name: 'Chosen part' }).getByRole('heading').first()).toContainText('new_engine');
	await page.getByRole('group', { name: 'How the model is shown' }).getByRole('button', { name: 'Graph' }).click();
	await expect(piece(page, 'operation:new_engine')).toHaveAttribute('aria-pressed', 'true');
	expect(complaints).toEqual([]);
});

test('usages of anything are found, from the station and from an expression; loose ends and findings are marked @long', async ({
	drafting,
	browse,
	complaints
}) => {
	await drafting.change('Something that nothing needs', [
		'resources/robot.yaml',
		'measured:\n',
		'estimated:\n  is_seen: {type: bool}\n\nmeasured:\n'
	]);
	// Older links lead to where it is now.
	const page = await browse(VERA, '/station?loose=on');
	await expect(page).toHaveURL(/\/model\?view=graph&loose=on$/);
	await expect(piece(page, 'variable:robot.is_seen')).toContainText('written by nothing');
	await expect(page.getByRole('complementary').filter({ hasText: 'Loose ends' })).toContainText('robot.is_seen');
	const marked = piece(page, 'variable:robot.is_seen').getByText(/findings? of the check/);
	await expect(marked).toBeAttached({ timeout: 40_000 });
	await drafting.undo();
	await expect(piece(page, 'variable:robot.is_seen')).toHaveCount(0);

	// A value, a type of message: whatever has a name.
	const search = page.getByRole('searchbox', { name: 'Find something' });
	await search.fill('tightened');
	await search.press('Enter');
	await expect(chosen(page).getByRole('heading', { level: 2 })).toContainText('bolt_state.tightened');
	await expect(above(page).locator('[data-manner="names"]')).toContainText('tighten_bolt_pair');
	await search.fill('RobotState');
	await page.getByRole('search').getByRole('button', { name: /RobotState/ }).click();
	await expect(above(page).locator('[data-manner="carries"]')).toContainText('/ur10/state');
	await above(page).getByRole('link', { name: /^resources\/robot\.yaml:\d+$/ }).first().click();
	await expect(page).toHaveURL(/\/model\?file=resources%2Frobot\.yaml&line=\d+$/);
	const form = page.getByRole('region', { name: 'Chosen part' });
	await expect(form.getByRole('heading').first()).toContainText('/ur10/state');

	await page.goto(`/model?${new URLSearchParams({ entry: 'operations.yaml#prepare_planning_scene' })}`);
	const goal = form.getByRole('textbox', { name: 'Goal', exact: true }).and(page.locator('.cm-content'));
	await goal.click();
	await goal.press('End');
	await goal.press('Shift+F12');
	const usages = page.getByRole('region', { name: 'Usages of robot.tool_is_attached' });
	await expect(usages.getByRole('status').first()).toContainText(/It is used in \d+ places/);
	await expect(usages).toContainText('topic /ur10/planning_scene/state');
	expect(await findings(page)).toEqual([]);
	// It stays while its usages are gone through.
	await usages.getByRole('button', { name: /^resources\/robot\.yaml:\d+$/ }).first().click();
	await expect(form.getByRole('heading').first()).not.toContainText('prepare_planning_scene');
	await expect(usages.getByRole('status').first()).toContainText(/It is used in \d+ places/);
	await page.goBack();
	await usages.getByRole('link', { name: 'Show it in the graph' }).click();
	await expect(chosen(page).getByRole('heading', { level: 2 })).toContainText('robot.tool_is_attached');
	await page.goBack();
	await goal.click();
	await goal.press('Home');
	await goal.press('F12');
	await expect(form.getByRole('heading').first()).not.toContainText('prepare_planning_scene');
	expect(complaints).toEqual([]);
});
