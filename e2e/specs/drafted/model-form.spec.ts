import type { Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { expression, field, form, unfold, write } from '../../station/editor.ts';
import { INA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const ABILITIES = [
	['engine', 'next_engine'],
	['nutrunner', 'run_nut'],
	['operator', 'place_bolt_pair'],
	['robot', 'move_to_position'],
	['robot', 'move_to_previous'],
	['robot', 'attach_in_planning_scene'],
	['robot', 'detach_in_planning_scene']
] as const;
const at = (resource: string, ability: string): string => `/model?${new URLSearchParams({ entry: `resources/${resource}.yaml#abilities#${ability}` })}`;
const section = (page: Page, name: string) => form(page).locator(`details[data-section="${name}"]`);

test('the form of each ability fits a screen, and folded sections tell what is in them', async ({ browse, complaints }) => {
	const page = await browse(INA, at('robot', 'move_to_position'));
	await page.setViewportSize({ width: 1440, height: 900 });
	for (const [resource, ability] of ABILITIES) {
		await page.goto(at(resource, ability));
		await expect(form(page).getByRole('heading', { name: ability })).toBeVisible();
		await expect(page.getByTestId('phase')).toBeVisible();
		await expect(expression(page, 'Enabled')).toBeVisible();
		const left = await form(page).evaluate((pane) => ({
			form: pane.scrollHeight - pane.clientHeight,
			across: pane.scrollWidth - pane.clientWidth,
			page: document.documentElement.scrollHeight - innerHeight
		}));
		expect.soft(left, ability).toEqual({ form: 0, across: 0, page: 0 });
	}

	await page.goto(at('robot', 'move_to_position'));
	await expect(section(page, 'what').locator('.told')).toHaveText('Move to {position} · Parameters: position named_pose · 2 – 3 s · Time limits: Must have reacted within 2, Finish 30 · What is wrong when it is late: The robot does not move off, The robot is not {target_pose} yet');
	await expect(section(page, 'course').locator('.told')).toHaveText('target_pose == position and pose != position');
	await expect(field(page, 'executing')).toBeHidden();
	expect(await findings(page)).toEqual([]);

	// By keyboard; as it is left it is found in the next.
	await section(page, 'course').locator('summary').focus();
	await page.keyboard.press('Enter');
	await expect(field(page, 'executing')).toBeVisible();
	await page.getByRole('treeitem', { name: 'move_to_previous' }).click();
	await expect(form(page).getByRole('heading', { name: 'move_to_previous' })).toBeVisible();
	await expect(field(page, 'executing')).toBeVisible();
	await page.reload();
	await expect(field(page, 'executing')).toBeVisible();
	await section(page, 'course').locator('summary').click();
	await expect(field(page, 'executing')).toBeHidden();
	expect(complaints).toEqual([]);
});

test('what is wrong in a folded section is marked at it, and what was not written is in sight again', async ({ browse }) => {
	const page = await browse(INA, at('robot', 'move_to_position'));
	await unfold(page, 'Under way');
	await write(expression(page, 'Executing'), 'target_pose == nonsense');
	await page.keyboard.press('Escape');
	await expect(field(page, 'executing').locator('[data-state="accepted"]')).toBeVisible();
	await section(page, 'course').locator('summary').click();
	await expect(section(page, 'course').locator('summary')).toContainText('1 error', { timeout: 60_000 });

	await section(page, 'what').locator('summary').click();
	await page.route('**/api/v1/model/changes', (route) => route.abort());
	await field(page, 'duration').getByRole('textbox').first().fill('1');
	await page.getByRole('treeitem', { name: 'move_to_previous' }).click();
	await section(page, 'what').locator('summary').click();
	await page.unroute('**/api/v1/model/changes');
	await page.getByRole('button', { name: /^Go to robot.move_to_position/ }).click();
	await expect(field(page, 'duration').getByRole('textbox').first()).toHaveValue('1');
	await expect(field(page, 'duration')).toBeVisible();
});

test('the form is usable in the hand', async ({ browse }) => {
	const page = await browse(INA, at('robot', 'move_to_position'));
	for (const width of [768, 390]) {
		await page.setViewportSize({ width, height: 844 });
		await expect(expression(page, 'Enabled')).toBeVisible();
		const across = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
		expect(across, String(width)).toBeLessThanOrEqual(0);
		await unfold(page, 'Finish');
		await expect(field(page, 'when')).toBeVisible();
		expect(await findings(page)).toEqual([]);
	}
});

test('the actions of an ability are put in another order by keys and by a button, with their comments', async ({ browse, drafting }) => {
	const page = await browse(INA, at('robot', 'attach_in_planning_scene'));
	const FILE = 'resources/robot.yaml';
	const text = async (): Promise<string> => {
		const answer = await page.context().request.get(`/api/v1/model/files?path=${FILE}`);
		return ((await answer.json()) as { files: Record<string, { text: string }> }).files[FILE]?.text ?? '';
	};
	const before = await text();
	const two = 'do:\n        # First.\n        - attach_tool := true\n        - target_pose := home # second';
	await drafting.change('Two actions', [FILE, 'do: [attach_tool := true]', two]);
	const now = before.replace('do: [attach_tool := true]', two);
	const row = (n: number) => expression(page, `Start: Actions, ${n}`);
	await expect(row(2)).toHaveText('target_pose := home');
	await row(2).focus();
	await page.keyboard.press('Alt+ArrowUp');
	await expect(row(1)).toHaveText('target_pose := home');
	await expect(row(1)).toBeFocused();
	expect(await text()).toContain('do:\n        - target_pose := home # second\n        # First.\n        - attach_tool := true\n');
	await page.keyboard.press('Alt+ArrowUp'); // it is the first
	await form(page).getByRole('button', { name: 'Move Start: Actions, 2 up' }).click();
	await expect(row(1)).toHaveText('attach_tool := true');
	await expect.poll(text).toBe(now);
});
