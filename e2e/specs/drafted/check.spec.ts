import type { Locator, Page } from '@playwright/test';
import { examine } from '../../station/barriers.ts';
import type { Replacement } from '../../station/drafting.ts';
import { check, form, panel, problems } from '../../station/editor.ts';
import { ERIK, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

const FORBIDS = (what: string): Replacement => [
	'specifications.yaml',
	'# Moving down',
	`never_so:\n  title: Never so\n  forbidden: ${what}\n\n# Moving down`
];
/** From now on the tool may start by itself. */
const BY_ITSELF: Replacement = [
	'resources/nutrunner.yaml',
	'when: run_tool_forward and not set_tool_idle and not tool_is_running_forward',
	'when: not tool_is_running_forward'
];

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

const verdict = (page: Page, is: string): Promise<void> =>
	expect(page.getByTestId('check')).toHaveAttribute('data-verdict', is, { timeout: 40_000 });
const player = (page: Page): Locator => page.getByTestId('trace');

test('a specification that cannot be met is found, with a run that plays', async ({ drafting, browse, complaints }) => {
	// Older links lead to where it is now.
	const page = await browse(ERIK, '/check');
	await expect(page).toHaveURL(/\/model\?panel=problems$/);
	await verdict(page, 'good');
	await expect(check(page)).toHaveText('Checked');
	await expect(page.getByText('Nothing was found.')).toBeVisible();
	await panel(page, 'Guards added');
	const guards = page.getByRole('region', { name: 'What the supervisor adds' });
	await expect(guards).toContainText('It adds to the guards of 6 abilities');
	await expect(guards.locator('[data-guard]')).toHaveCount(2);
	await expect(guards.locator('[data-guard="robot.move_to_position(position)"]')).toContainText(
		'no_standing_tool_on_placed_bolts(position)'
	);

	await drafting.change('The tool starts by itself, and must not', BY_ITSELF, FORBIDS('nutrunner.tool_is_running_forward'));
	await verdict(page, 'unmeetable');
	const found = page.locator('[data-finding="specification-cannot-be-met"]');
	await expect(check(page)).toHaveText('No supervisor: nothing could start');
	await expect(page.getByText('There is none.')).toBeVisible();
	await panel(page, 'Problems');
	await expect(found.getByRole('button', { name: /^specifications\.yaml:\d+$/ })).toBeVisible();
	await found.getByRole('button', { name: 'Play how it comes about, in 1 step' }).click();
	await expect(player(page)).toContainText('The initial state');
	await player(page).getByRole('button', { name: 'Next' }).click();
	await expect(player(page).getByRole('status')).toContainText('This state is forbidden by never_so');
	await expect(player(page).locator('[data-value="nutrunner.tool_is_running_forward"]')).toHaveText('true');
	// Runs are shown together, too.
	await panel(page, 'Tried runs');
	await expect(page.getByRole('list', { name: 'Runs that show what the check found' }).getByRole('listitem').first()).toContainText('never_so');
	expect(complaints).toEqual([]);
});

test('a longer run plays by keyboard, each step with what it changes @long', async ({ drafting, browse, complaints }) => {
	await drafting.change('The first pair is never tightened', FORBIDS('bolts[bolt_pair_1] == tightened'));
	await drafting.checked();
	const page = await browse(VERA, '/model?panel=problems');
	await verdict(page, 'good');
	const found = page.locator('[data-finding="goal-lost"]').first();
	await found.getByRole('button', { name: /^Play how it comes about, in \d+ steps$/ }).press('Enter');
	const slider = player(page).getByRole('slider', { name: 'Step' });
	await slider.focus();
	await page.keyboard.press('ArrowRight');
	await expect(player(page)).toHaveAttribute('data-place', '1');
	await expect(player(page).getByRole('status')).toContainText('Start of');
	await expect(player(page).locator('[data-changed="true"]')).not.toHaveCount(0);
	await page.keyboard.press('End');
	const last = Number(await slider.getAttribute('max'));
	expect(last).toBeGreaterThan(3);
	await expect(slider).toHaveAttribute('aria-valuetext', `Step ${last} of ${last}`);
	await expect(player(page).locator('[data-value="bolts[bolt_pair_1]"]')).toHaveText('tightened');
	await expect(player(page).getByRole('status')).toContainText('forbidden by never_so');
	await expect(player(page).getByRole('button', { name: 'Next' })).toHaveAttribute('aria-disabled', 'true');
	await page.keyboard.press('Home');
	await expect(player(page)).toHaveAttribute('data-place', '0');
	await player(page).getByRole('button', { name: /^2 / }).press('Enter');
	await expect(player(page)).toHaveAttribute('data-place', '2');
	await player(page).getByText('An ability in this step').press('Enter');
	const [ability, course] = [player(page).getByLabel('Ability', { exact: true }), page.getByTestId('run-phase')];
	await expect(course).toHaveAttribute('data-phase', /^(executing|finished|enabled|idle)$/, { timeout: 20_000 });
	await ability.selectOption('robot.move_to_position(above_engine)');
	await expect(page.getByTestId('automaton')).toContainText('robot.target_pose == robot.pose');
	await expect(page.getByTestId('supervised')).toHaveCount(0);
	await examine(page, 'check');

	await page.setViewportSize({ width: 1440, height: 900 });
	await page.getByLabel('Grouped by').selectOption('file');
	await expect(page.locator('[data-group="operations.yaml"]')).toBeVisible();
	await drafting.undo();
	expect(complaints).toEqual([]);
});

test('what cannot be read is an error, and leads to its line', async ({ drafting, browse, complaints }) => {
	const page = await browse(ERIK, '/model');
	await drafting.change('A name that nobody knows', ['operations.yaml', 'goal: bolts[pair] == placed', 'goal: nuts[pair] == placed']);
	await verdict(page, 'unusable');
	const error = page.locator('[data-finding="unusable"]').first();
	await expect(error).toContainText('nuts');
	await expect(check(page)).toHaveText(/^Cannot be used: \d+ errors?$/);
	await error.getByRole('button', { name: /^operations\.yaml:\d+$/ }).click();
	await expect(form(page).getByRole('heading').first()).toContainText('place_bolt_pair');
	expect(complaints).toEqual([]);
});

test('a Swedish page tells what is found in Swedish, with the names of the model as they are', async ({ drafting, browse, complaints }) => {
	const page = await browse(ERIK, '/model', { locale: 'sv-SE' });
	await expect(page.locator('html')).toHaveAttribute('lang', 'sv');
	await drafting.change('A specification that forbids nothing', FORBIDS('robot.pose == home and robot.pose != home'));
	await verdict(page, 'good');
	const found = page.locator('[data-finding]');
	await expect(found).toHaveCount(1);
	await expect(found).toContainText('`never_so` förbjuder inget: inget tillstånd, oavsett om det kan nås, är som den säger');

	await drafting.change('A key that nobody knows', ['operations.yaml', 'goal: ', 'goall: 1\n  goal: ']);
	await verdict(page, 'unusable');
	await expect(found).toHaveCount(1);
	await expect(found).toContainText('`goall` är inte känt här; menade du `goal`?');
	await expect(problems(page, 'Problem').locator('[lang=en]')).toHaveCount(0);
	await drafting.undo();
	await drafting.undo();
	expect(complaints).toEqual([]);
});
