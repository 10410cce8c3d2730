import type { Locator } from '@playwright/test';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import { restsOnPerson, variable } from '../../station/seen.ts';
import { EXECUTABLE, ROOT } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

/** The server prepares the model, then simulates, with what the machine has to spare. */
const SIMULATED = { timeout: 60_000 };

test('the draft is tried in simulated time: on, back, otherwise, with faults, and nothing of it happens', async ({ operate, state, watch }) => {
	await restsOnPerson(operate, watch);
	const requested = variable(state, 'operator.requested_pair');
	const before = await requested.getAttribute('data-value');
	await operate.getByRole('link', { name: 'What-if' }).click();
	const main = operate.locator('main');
	const time = main.getByTestId('simulated-time');
	const moment = main.getByRole('slider', { name: 'Moment' });
	const seconds = async (): Promise<number> => Number(await time.getAttribute('data-seconds'));

	await main.getByRole('button', { name: 'In simulated time' }).click();

	await test.step('its clock runs as fast as is wanted, and people do what they are asked', async () => {
		await main.getByRole('combobox', { name: 'Speed' }).selectOption('10×', SIMULATED);
		await main.getByRole('button', { name: 'Play' }).click();
		await expect.poll(seconds, SIMULATED).toBeGreaterThan(10);
		await expect(main.locator('.lanes .bar.past')).not.toHaveCount(0);
		await main.getByRole('button', { name: 'Stop the clock' }).click();
		await expect(main.getByRole('button', { name: 'Play' })).toBeVisible();
	});

	await test.step('until a condition holds; one that is none is refused', async () => {
		const condition = main.getByRole('textbox', { name: 'Condition' });
		await condition.fill(`bolts[${before}] == tigtened`);
		await main.getByRole('button', { name: 'Run until' }).click();
		await expect(main.getByRole('alert')).toContainText('tigtened', SIMULATED);
		await condition.fill(`bolts[${before}] == tightened`);
		await main.getByRole('button', { name: 'Reset' }).click();
		await expect(time).toHaveAttribute('data-seconds', '0', SIMULATED);
		await main.getByRole('button', { name: 'Run until' }).click();
		await expect(main.getByText('The condition holds')).toBeVisible(SIMULATED);
		await expect(main.getByRole('region', { name: 'State' })).toContainText('tight');
	});

	await test.step('back at a moment it goes on otherwise', async () => {
		const end = await seconds();
		await moment.press('ArrowLeft');
		await moment.press('ArrowLeft');
		await expect(time).toContainText('What you do now is done here');
		await main.getByRole('combobox', { name: 'Device' }).selectOption({ label: 'Nutrunner' });
		await main.getByRole('button', { name: 'Says nothing' }).click();
		await expect(main.getByRole('list', { name: 'Faults' })).toContainText('Nutrunner says nothing', SIMULATED);
		expect(await seconds()).toBeLessThan(end);
		await main.getByRole('button', { name: 'End it: Nutrunner says nothing' }).click();
		await expect(main.getByRole('list', { name: 'Faults' })).toHaveCount(0, SIMULATED);
	});

	await test.step('people wait until somebody says that they are done', async () => {
		await main.getByRole('button', { name: 'Reset' }).click();
		await expect(time).toHaveAttribute('data-seconds', '0', SIMULATED);
		await main.getByRole('checkbox', { name: 'They do their tasks by themselves' }).uncheck();
		await main.getByRole('button', { name: 'To what happens next' }).click();
		await main.getByRole('list', { name: 'Tasks' }).getByRole('button').click(SIMULATED);
		await expect(main.getByRole('region', { name: 'State' })).toContainText('acknowledged', SIMULATED);
	});

	await test.step('from a record of the past', async () => {
		await main.getByRole('combobox', { name: 'Begins with' }).selectOption('a record of its history');
		await main.getByRole('spinbutton', { name: 'Number of the record' }).fill('1000000000');
		await main.getByRole('button', { name: 'Reset' }).click();
		await expect(main.getByRole('alert')).toContainText('no such record', SIMULATED);
	});

	await examine(operate, 'what-if');
	await expect(requested).toHaveAttribute('data-value', before ?? '');
});

test('the station is led through the draft step by step, in branches, and until a condition holds', async ({ operate, state, watch }) => {
	await restsOnPerson(operate, watch);
	const requested = variable(state, 'operator.requested_pair');
	const before = await requested.getAttribute('data-value');
	await operate.getByRole('link', { name: 'What-if' }).click();
	const main = operate.locator('main');
	const step = main.getByRole('slider', { name: 'Step' });
	const person = main.getByRole('button', { name: 'Take: the task is acknowledged' });

	await test.step('what can happen next is offered, and one of it is taken', async () => {
		await expect(step).toHaveAttribute('aria-valuenow', '0', SIMULATED);
		await person.click();
		await expect(step).toHaveAttribute('aria-valuenow', '1', SIMULATED);
		await expect(main.getByRole('region', { name: 'State' })).toContainText('placed');
	});

	await test.step('back at the beginning it goes on otherwise, in a branch of its own', async () => {
		await step.press('ArrowLeft');
		await expect(step).toHaveAttribute('aria-valuenow', '0');
		await main.getByRole('button', { name: 'New branch from here' }).click();
		await expect(main.getByRole('list', { name: 'Branches' }).getByRole('listitem')).toHaveCount(2, SIMULATED);
		await expect(person).toBeVisible();
	});

	await test.step('plans are followed until a condition holds', async () => {
		await main.getByLabel('Condition', { exact: true }).fill(`bolts[${before}] == tightened`);
		await main.getByRole('button', { name: 'Run until' }).click();
		await expect(main.getByText('The condition holds.')).toBeVisible(SIMULATED);
		await expect(main.getByRole('region', { name: 'State' })).toContainText('tight');
		await main.getByLabel('Condition', { exact: true }).fill(`bolts[${before}] == tigtened`);
		await main.getByRole('button', { name: 'Run until' }).click();
		await expect(main.getByRole('alert')).toContainText('tigtened', SIMULATED);
	});

	await test.step('somebody loosens what is tight while the tool stands on it, and the station says where it is then', async () => {
		await main.getByText('Disturb something').click();
		await main.getByLabel('Variable', { exact: true }).selectOption(`bolts[${before}]`);
		await main.getByLabel('Becomes').selectOption('placed');
		await main.getByRole('button', { name: 'Let it be so' }).click();
		await expect(main.getByText('outside the safe states')).toBeVisible(SIMULATED);
	});

	await examine(operate, 'what-if-steps');
	await expect(requested).toHaveAttribute('data-value', before ?? '');
});

test('the state space of the draft is folded by chosen variables, with the plan on it and where starts are kept back', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.getByRole('link', { name: 'What-if' }).click();
	const main = operate.locator('main');
	await main.getByRole('button', { name: 'State space' }).click();
	const picture = main.getByTestId('state-space');
	const counts = main.getByTestId('space-counts');
	const nodes = picture.locator('[data-node]');
	const folded = main.getByRole('group', { name: 'Folded by' });

	await test.step('a choice is made first, with the present and the plan on it', async () => {
		await expect(picture).toHaveAttribute('data-laid', 'true', SIMULATED);
		await expect(nodes.first()).toBeVisible();
		await expect(picture.locator('[data-mark="present"]')).not.toHaveCount(0);
		await expect(picture.locator('[data-mark="initial"]')).toHaveCount(1);
		await expect(picture.locator('[data-mark="unsafe"]')).not.toHaveCount(0);
		await expect(main.getByRole('region', { name: 'Plan on it' }).getByRole('listitem').first()).toContainText('The beginning');
	});

	await test.step('it begins at the state of the station, large enough to be read, and all of it is a press away', async () => {
		const box = (locator: Locator) => locator.evaluate((each) => each.getBoundingClientRect().toJSON() as DOMRect);
		const scale = (): Promise<number> => picture.locator('.svelte-flow__viewport').evaluate((each) => new DOMMatrix(getComputedStyle(each).transform).a);
		const cut = (): Promise<string[]> =>
			nodes.locator('.of, strong').evaluateAll((all) => all.filter((each) => each.scrollWidth > each.clientWidth + 1 || each.scrollHeight > each.clientHeight + 1).map((each) => each.textContent));
		for (const [width, height] of [[1440, 900], [768, 1024], [390, 844]] as const) {
			await operate.setViewportSize({ width, height });
			await operate.reload();
			await expect(picture).toHaveAttribute('data-laid', 'true', SIMULATED);
			const present = nodes.filter({ has: operate.locator('[data-mark="present"]') });
			await expect(present).toBeInViewport();
			const letters = await present.locator('span, strong').evaluateAll((all) => Math.min(...all.map((each) => parseFloat(getComputedStyle(each).fontSize))));
			expect(letters * (await scale()), `pixels of the letters on a screen of ${width}`).toBeGreaterThanOrEqual(11);
			const [room, at] = [await box(picture), await box(present)];
			expect(at.left).toBeGreaterThanOrEqual(room.left);
			expect(at.right).toBeLessThanOrEqual(room.right);
			expect(at.top).toBeGreaterThanOrEqual(room.top);
			expect(at.bottom).toBeLessThanOrEqual(room.bottom);
			expect(await cut(), `cut on a screen of ${width}`).toEqual([]);
		}
		await operate.setViewportSize({ width: 1440, height: 900 });
		await picture.getByRole('button', { name: 'Show all of it' }).click();
		await expect.poll(scale).toBeLessThan(1);
		const [room, all] = [await box(picture), await nodes.evaluateAll((every) => every.map((each) => each.getBoundingClientRect().toJSON() as DOMRect))];
		expect(all.length).toBeGreaterThan(1);
		for (const each of all) {
			expect(each.left).toBeGreaterThanOrEqual(room.left);
			expect(each.right).toBeLessThanOrEqual(room.right);
			expect(each.bottom).toBeLessThanOrEqual(room.bottom);
		}
	});

	await test.step('the view stands in the address: a reload, a link and Back lead to it', async () => {
		await expect(operate).toHaveURL(/\/what-if\?view=space$/);
		await main.getByRole('button', { name: 'Step by step' }).click();
		await expect(operate).toHaveURL(/view=steps$/);
		await expect(picture).toHaveCount(0);
		await operate.goBack();
		await expect(main.getByRole('button', { name: 'State space' })).toHaveAttribute('aria-pressed', 'true');
		await expect(picture).toHaveAttribute('data-laid', 'true', SIMULATED);
		await operate.getByRole('link', { name: 'State', exact: true }).click();
		await expect(operate).toHaveURL(/\/state$/);
		await operate.goBack();
		await expect(picture).toHaveAttribute('data-laid', 'true', SIMULATED);
	});
	await examine(operate, 'state-space');

	await test.step('the keyboard leads from node to node and to what is said of one', async () => {
		const stop = picture.locator('.svelte-flow__node[tabindex="0"]');
		await expect(stop).toHaveCount(1);
		await stop.focus();
		await operate.keyboard.press('Home');
		await expect(picture.locator('.svelte-flow__node[data-id="0"]')).toBeFocused();
		await operate.keyboard.press('ArrowRight');
		await expect(picture.locator('.svelte-flow__node[data-id="0"]')).not.toBeFocused();
		await operate.keyboard.press('Enter');
		await expect(main.getByRole('heading', { name: 'Node', exact: true })).toBeFocused();
		await expect(main.getByRole('region', { name: 'Node', exact: true })).toContainText('Led to by');
	});

	await test.step('fewer variables make fewer nodes, and the supervisor nothing that is not safe', async () => {
		await folded.getByRole('button', { name: 'Without bolt pair 1' }).click();
		await expect(counts).toContainText('9 nodes', SIMULATED);
		await main.getByRole('button', { name: 'With the supervisor' }).click();
		await expect(picture.locator('[data-mark="unsafe"]')).toHaveCount(0, SIMULATED);
		await folded.getByRole('combobox', { name: 'Fold by a further variable' }).selectOption({ label: 'the pose of the robot (6)' });
		await expect(counts).not.toContainText(/^9 nodes/, SIMULATED);
	});

	await test.step('a table says the same', async () => {
		await main.getByRole('button', { name: 'Table', exact: true }).click();
		const rows = main.getByTestId('state-space-table').locator('tbody tr');
		await expect(counts).toContainText(`${await rows.count()} nodes`);
		await examine(operate, 'state-space-table');
		await main.getByRole('button', { name: 'Picture', exact: true }).click();
	});

	await test.step('a condition that is none is refused, one that is met is planned for', async () => {
		const until = main.getByRole('textbox', { name: 'Or until a condition holds' });
		await until.fill('robot.pose == moon');
		await main.getByRole('button', { name: 'Show', exact: true }).click();
		await expect(main.getByRole('alert')).toContainText('moon', SIMULATED);
		await until.fill('robot.pose == above_engine');
		await main.getByRole('button', { name: 'Show', exact: true }).click();
		await expect(main.getByText('moon')).toHaveCount(0, SIMULATED);
		await expect(main.getByRole('button', { name: 'To the goals of what is active' })).toBeVisible();
	});

	await test.step('from the guards of the model to where a start is kept back', async () => {
		await operate.getByRole('link', { name: 'Model', exact: true }).click();
		await main.getByRole('tab', { name: /^Guards added/ }).click();
		await main.getByRole('link', { name: 'Where it is kept back' }).first().click(SIMULATED);
		await expect(main.getByText(/^Where the supervisor keeps it back/)).toBeVisible(SIMULATED);
		await expect(picture).toHaveAttribute('data-laid', 'true', SIMULATED);
		await expect(picture.locator('[data-mark="cut"]')).not.toHaveCount(0);
		await main.getByRole('button', { name: 'Look at all again' }).click();
		await expect(picture.locator('[data-mark="cut"]')).toHaveCount(0, SIMULATED);
		await expect(operate).toHaveURL(/\/what-if\?view=space$/);
	});
});

test('what-if begins from a moment of a recording of the traffic, with what it lacks', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const folder = mkdtempSync(join(tmpdir(), 'recording-'));
	const script = join(import.meta.dirname, '../../station/recording.py');
	const made = spawnSync(join(dirname(EXECUTABLE), 'python'), [script, join(ROOT, 'models/bolt_tightening'), join(folder, 'drive')], { encoding: 'utf8' });
	expect(made.stderr).toBe('');
	await operate.getByRole('link', { name: 'What-if' }).click();
	const main = operate.locator('main');
	const moment = main.getByRole('slider', { name: 'Moment of the recording' });
	const pose = main.locator('[data-variable="robot.pose"]');

	await test.step('what is no recording is refused, with what to do', async () => {
		await main.getByRole('combobox', { name: 'Where it begins' }).selectOption('A recording of ROS 2 traffic', SIMULATED);
		writeFileSync(join(folder, 'note.mcap'), 'hello');
		await main.locator('input[type=file]').setInputFiles(join(folder, 'note.mcap'));
		await expect(main.getByRole('alert').filter({ hasText: 'note.mcap is no recording: choose a .mcap or a .db3 file' })).toBeVisible(SIMULATED);
	});

	await test.step('a recording is read, and says what it lacks', async () => {
		await main.locator('input[type=file]').setInputFiles(join(folder, 'drive', 'drive.mcap'));
		await expect(main.getByRole('heading', { name: 'drive.mcap' })).toBeVisible(SIMULATED);
		const lacks = main.locator('details');
		await expect(lacks).toContainText('/ur10/planning_scene/state');
		await expect(lacks).toContainText('1 message, the first at 0:00.750');
		await expect(main.getByText('1 other topic with 1 message passed over')).toBeVisible();
	});

	await test.step('a moment is chosen, and tells where the station was', async () => {
		await moment.focus();
		await moment.press('Home');
		await expect(pose).toHaveAttribute('data-value', 'home');
		await moment.press('End');
		await expect(pose).toHaveAttribute('data-value', 'above_engine');
		await expect(main.locator('[data-variable="nutrunner.tool_is_idle"]')).toHaveAttribute('data-standing', 'stale');
		await expect(main.locator('[data-variable="robot.tool_is_attached"]')).toHaveAttribute('data-standing', 'not-recorded');
	});
	await examine(operate, 'what-if-recording');

	await test.step('it begins there, and a step is taken', async () => {
		await main.getByRole('button', { name: 'Begin from here' }).click();
		const step = main.getByRole('slider', { name: 'Step' });
		await expect(step).toHaveAttribute('aria-valuenow', '0', SIMULATED);
		const state = main.getByRole('region', { name: 'State' });
		await state.getByRole('button', { name: /^All/ }).click();
		await expect(state).toContainText('above the engine');
		await main.getByRole('button', { name: /^Take: / }).first().click();
		await expect(step).toHaveAttribute('aria-valuenow', '1', SIMULATED);
		await main.getByRole('button', { name: 'Choose another moment' }).click();
		await expect(moment).toBeVisible();
	});

	await test.step('and in simulated time', async () => {
		await main.getByRole('button', { name: 'In simulated time' }).click();
		await main.getByRole('combobox', { name: 'Begins with' }).selectOption('a recording of ROS 2 traffic', SIMULATED);
		await main.getByRole('button', { name: 'Begin from here' }).click(SIMULATED);
		await expect(main.getByTestId('simulated-time')).toHaveAttribute('data-seconds', '0', SIMULATED);
		const state = main.getByRole('region', { name: 'State' });
		await state.getByRole('button', { name: /^All/ }).click();
		await expect(state).toContainText('above the engine');
	});
	rmSync(folder, { recursive: true });
});
