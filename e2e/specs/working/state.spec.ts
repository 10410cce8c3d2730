import { findings, smallTargets } from '../../station/barriers.ts';
import { acknowledge, picture, restsOnPerson, takeControl, variable } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';
import type { Locator, Page } from '@playwright/test';

const BOLTS = (pair: string): string => `bolts[${pair}]`;

/** Opens the correction of an estimate and chooses a value; what follows is worked out by itself. */
async function lookAt(page: Page, name: string, value: string): Promise<Locator> {
	await page.locator(`[data-row="${name}"]`).getByRole('button', { name: /^Correct…/ }).click();
	const dialog = page.getByRole('dialog');
	await dialog.getByRole('radio', { name: value }).check();
	await expect(dialog.getByTestId('follows')).toBeVisible();
	return dialog;
}

/** Asks the server for something as the page would. */
async function ask(page: Page, method: string, path: string, body: object): Promise<void> {
	const status = await page.evaluate(
		async ([method, path, body]) => {
			const headers = { 'Content-Type': 'application/json' };
			return (await fetch(`/api/v1/${path}`, { method, headers, body })).status;
		},
		[method, path, JSON.stringify(body)] as const
	);
	expect(status).toBeLessThan(300);
}

/** Takes control over, whoever has it, while a dialog is open. */
async function seize(page: Page): Promise<void> {
	const over = await page.evaluate(async () => {
		const { control } = (await (await fetch('/api/v1/station')).json()) as { control: { session: string } | null };
		return control?.session ?? null;
	});
	await ask(page, 'PUT', 'control-lock', { over, reason: 'It is my turn' });
	await expect(page.getByTestId('control')).toHaveAttribute('data-holder', 'you');
}

/** Presses the one act, and confirms it where it leads out of the safe states. */
async function made(dialog: Locator, act: string, yes: string): Promise<void> {
	await dialog.getByRole('button', { name: act }).click();
	const [sure, moved] = [dialog.getByTestId('sure'), dialog.getByTestId('moved')];
	await expect.poll(async () => (await dialog.isHidden()) || (await sure.isVisible()) || (await moved.isVisible())).toBe(true);
	if (await sure.isVisible()) await dialog.getByRole('button', { name: yes }).click();
}

test('a variable is found by words of it, and seen to change @theme', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, '/state?kind=estimated');
	await expect(state.locator('[data-row]')).toHaveCount(3);
	await state.getByLabel('Search', { exact: true }).fill('pair nowhere');
	await expect(state.getByText('No variable is like that')).toBeVisible();

	await state.getByLabel('Search', { exact: true }).fill('empty bolts');
	await expect(state.locator('[data-row]')).not.toHaveCount(0); // the one that a person is asked to place
	const before = await state.locator('[data-row]').count();
	const pair = await acknowledge(watch);
	await expect(state.locator('[data-row]')).toHaveCount(before - 1);
	await state.getByLabel('Search', { exact: true }).fill(`PAIR bolts ${pair.at(-1)}`);
	await expect(state).toHaveURL(/kind=estimated/);
	await expect(variable(state, BOLTS(pair))).toHaveAttribute('data-value', /placed|tightened/);
	await expect(state.locator(`[data-row="${BOLTS(pair)}"]`)).toContainText(/Place bolt pair|Run the nutrunner|Run nut|Tighten/);

	await state.getByRole('button', { name: 'Show all' }).click();
	expect(await findings(state)).toEqual([]);
	await picture(state, 'state');
	for (const width of [768, 320]) {
		await state.setViewportSize({ width, height: 900 });
		expect(await smallTargets(state)).toEqual([]);
		await picture(state, `state-${width}`);
	}
});

test('how a variable went is drawn from the journal, and stands in a table as well', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const name = 'robot.pose';
	const state = await browse(null, `/state?variable=${name}`);
	const drawer = state.getByRole('dialog');
	const chart = drawer.getByRole('img', { name: /changes? in the last 10 min; .* now$/ });
	await expect(chart.locator('canvas')).toBeVisible();
	const before = Number.parseInt((await chart.getAttribute('aria-label')) ?? '', 10);
	expect(before).toBeGreaterThan(0);
	// From its right end, the present, to the left: the station has not been there for long.
	const { x = 0, y = 0, width = 0 } = (await chart.boundingBox()) ?? {};
	let away = 0;
	await expect
		.poll(async () => {
			await state.mouse.move(x + width - (away += 4), y + 20);
			return drawer.locator('figcaption').textContent();
		})
		.toContain(', since ');
	expect(await findings(state)).toEqual([]);
	await picture(state, 'course');

	await drawer.getByRole('button', { name: 'as table' }).click();
	const rows = drawer.getByRole('table', { name: 'How it went' }).locator('tbody tr');
	const shown = await rows.count();
	expect(shown).toBeGreaterThanOrEqual(before);
	expect(await findings(state)).toEqual([]);
	await acknowledge(watch);
	await expect.poll(() => rows.count(), { timeout: 60_000 }).toBeGreaterThan(shown);
});

test('an estimate is corrected after what follows was seen, and that is taken back @long', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const [state, other] = [await browse(null, '/state?kind=estimated'), await browse(null, '/state?kind=estimated')];
	const row = state.locator('[data-row]').filter({ has: state.locator('[data-value="empty"]') }).first();
	const name = (await row.getAttribute('data-row')) ?? '';

	await test.step('one press takes control, enters restart mode and corrects, each an act of its own', async () => {
		const dialog = await lookAt(state, name, 'placed');
		const act = dialog.getByRole('button', { name: 'Correct to placed' });
		await expect(act).toHaveAttribute('aria-disabled', 'true');
		await expect(dialog).toContainText('Takes control and enters restart mode first');
		await dialog.getByLabel('Reason').fill('It is in its hole');
		await expect(dialog.getByTestId('follows')).toContainText('safe states');
		expect(await findings(state)).toEqual([]);
		await picture(state, 'correct');
		await made(dialog, 'Correct to placed', 'Yes, correct it');
		await expect(state.getByTestId('control')).toHaveAttribute('data-holder', 'you');
		await expect(state.getByTestId('mode')).toContainText('Restart');
	});

	await test.step('it is told with the way back, which is looked at first as well', async () => {
		await state.getByTestId('toasts').getByRole('button', { name: 'Take it back…' }).click();
		const undo = state.getByRole('dialog', { name: 'Take the last correction back' });
		await expect(undo.getByTestId('follows')).toBeVisible();
		await undo.getByRole('button', { name: 'Cancel' }).click();
	});

	await test.step('everybody sees it, and who corrected it', async () => {
		for (const page of [state, other]) {
			await expect(variable(page, name)).toHaveAttribute('data-value', 'placed');
			await expect(page.getByTestId('last-correction')).toContainText('It is in its hole');
		}
	});

	await test.step('two who looked at the same state cannot both correct it', async () => {
		const [undo, dialog] = [state.getByRole('dialog'), await lookAt(other, name, 'tight')];
		await state.getByTestId('last-correction').getByRole('button').click();
		await undo.getByLabel('Reason').fill('It was another pair');
		await dialog.getByLabel('Reason').fill('It is tight');
		await seize(other);
		// The second one's request is on its way while the first one takes the correction back.
		await other.route('**/api/v1/corrections', async (route) => {
			await seize(state);
			await made(undo, 'Take back', 'Yes, take it back');
			await expect(variable(state, name)).toHaveAttribute('data-value', 'empty');
			await seize(other);
			await route.continue();
		});
		await made(dialog, 'Correct to tight', 'Yes, correct it');
		await expect(dialog).toContainText('The state has moved');
		await expect(dialog.getByRole('alert').filter({ hasText: 'Something has changed' })).toBeVisible();
		await expect(dialog.getByTestId('moved')).toContainText('placed → empty');
		await expect(dialog.getByRole('radio', { name: 'tight' })).toBeChecked();
		await expect(dialog.getByRole('button', { name: 'Correct to tight' })).toHaveAttribute('aria-disabled', 'true');
		await expect(undo).toBeHidden();
		await expect(variable(state, name)).toHaveAttribute('data-value', 'empty');
		await dialog.getByRole('button', { name: 'Cancel' }).click();
	});

	await ask(other, 'POST', 'restart/leave', {});
	await ask(other, 'PUT', 'mode', { mode: 'automatic' });
	await expect(state.getByTestId('mode')).toContainText('Automatic');
});

test('from any page a correction is four presses away: control and restart mode are taken by the last @long', async ({
	operate,
	watch,
	browse
}) => {
	await restsOnPerson(operate, watch);
	// Who took it before may have it still: to take it from somebody is a press more.
	await takeControl(operate);
	await operate.getByRole('button', { name: 'Release control' }).click();
	await expect(operate.getByTestId('control')).toHaveAttribute('data-holder', 'nobody');
	const page = await browse(null, '/history');
	await page.evaluate(() => {
		const counted = window as unknown as { presses: number };
		counted.presses = 0;
		addEventListener('pointerdown', () => (counted.presses += 1), true);
	});
	await page.getByRole('link', { name: 'State', exact: true }).click();
	const row = page.locator('[data-row]').filter({ has: page.locator('[data-value="empty"]') }).first();
	const name = (await row.getAttribute('data-row')) ?? '';
	await row.getByRole('button', { name: /^Correct…/ }).click();
	const dialog = page.getByRole('dialog');
	await dialog.locator('label').filter({ hasText: 'tight' }).click();
	await page.keyboard.type('Tightened by hand, 45 Nm');
	await dialog.getByRole('button', { name: 'Correct to tight' }).click();
	await expect(variable(page, name)).toHaveAttribute('data-value', 'tightened');
	expect(await page.evaluate(() => (window as unknown as { presses: number }).presses)).toBeLessThanOrEqual(4);
	await expect(page.getByTestId('last-correction')).toContainText('Tightened by hand, 45 Nm');
	await ask(page, 'POST', 'restart/leave', {});
	await ask(page, 'PUT', 'mode', { mode: 'automatic' });
});

test('variables are kept in sight, also when the page is opened again', async ({ operate, watch, browse, complaints }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, '/state');
	for (const name of ['robot.pose', BOLTS('bolt_pair_2')]) {
		await state.goto(`/state?variable=${encodeURIComponent(name)}`);
		await state.getByRole('dialog').getByRole('button', { name: 'Watch', exact: true }).click();
		await state.getByRole('dialog').getByRole('button', { name: 'Close' }).first().click();
	}
	await expect(state.locator('[data-row]')).not.toHaveCount(2);
	await state.getByTestId('watched').click();
	await expect(state.locator('[data-row]')).toHaveCount(2);
	await expect(state.locator('[data-row="robot.pose"]')).toBeVisible();
	await state.reload();
	await expect(state.getByTestId('watched')).toContainText('2');
	expect(await findings(state)).toEqual([]);
	expect(complaints).toEqual([]);
});

test('the station pauses at a breakpoint, says so, and goes on', async ({ operate, watch, browse, complaints }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, `/state?variable=${encodeURIComponent('robot.pose')}`);
	await state.getByRole('button', { name: 'Pause when…' }).click();
	const dialog = state.getByRole('dialog', { name: 'Breakpoints' });
	const condition = dialog.getByLabel('Pause when', { exact: true });
	await expect(condition).toHaveValue(/^robot\.pose == /);
	await condition.fill('robot.pose == abvoe_engine');
	await condition.press('Enter');
	await expect(dialog.locator('mark')).toHaveText('abvoe_engine');
	await condition.fill('nutrunner.tool_is_running_forward');
	await condition.press('Enter');
	await expect(dialog.locator('[data-breakpoint="nutrunner.tool_is_running_forward"]')).toContainText('not yet');
	expect(await findings(state)).toEqual([]);
	await dialog.getByRole('button', { name: 'Close' }).click();
	await expect(state.getByTestId('breakpoints')).toContainText('1');

	await acknowledge(watch);
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-mode', 'paused', { timeout: 60_000 });
	await expect(operate.getByTestId('at-breakpoint')).toBeVisible();
	await state.getByTestId('breakpoints').click();
	await expect(dialog.locator('[data-breakpoint="nutrunner.tool_is_running_forward"]')).toContainText('Stopped here');
	await dialog.getByRole('button', { name: 'Remove nutrunner.tool_is_running_forward' }).click();
	await expect(dialog).toContainText('There are none.');
	await dialog.getByRole('button', { name: 'Close' }).click();
	await takeControl(operate);
	await operate.getByRole('button', { name: 'Continue' }).click();
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-mode', 'automatic');
	await restsOnPerson(operate, watch);
	expect(complaints.filter((each) => !each.includes('422'))).toEqual([]);
});
