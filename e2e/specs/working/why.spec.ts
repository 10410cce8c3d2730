import { findings, overflow, smallTargets } from '../../station/barriers.ts';
import { acknowledge, picture, restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';
import type { Locator, Page } from '@playwright/test';

/** Opens a part of a tree, as with the keyboard. */
async function open(details: Locator): Promise<void> {
	await details.locator(':scope > summary').press('Enter');
	await expect(details).toHaveAttribute('open', '');
}

/** The pair of bolts that a person is asked to place. */
async function asked(page: Page): Promise<string> {
	const step = (await page.locator('[data-status="running"]').getAttribute('data-step')) ?? '';
	return /bolt_pair_\d/.exec(step)?.[0] ?? '';
}

test('a condition is followed from an operation down to the person who can change it @theme', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const pair = await asked(operate);
	const group = operate.locator('[data-operations="tighten_bolt_pair"]');
	await group.getByRole('button', { name: /\d of 3/ }).press('Enter');
	const title = `Tighten ${pair.replaceAll('_', ' ')}`;
	await group.getByRole('button', { name: `Why? ${title}` }).click();
	const dialog = operate.getByRole('dialog', { name: `What “${title}” waits for` });
	// What does not hold is told by its sign and in words, and is open down to its variable.
	const placed = dialog.locator('[data-about="precondition"] li[data-decides="true"]').first();
	await expect(placed).toContainText('✕');
	await expect(placed).toContainText('does not hold');
	await expect(placed.locator(`[data-involved="bolts[${pair}]"]`).first()).toContainText('Could be changed by');
	const place = placed.locator(`[data-why="ability operator.place_bolt_pair(${pair})"]`);
	await expect(place).toContainText('which runs');
	await open(place);
	await expect(place.locator('[data-about="finish"] li[data-holds="true"]').first()).toContainText('✓');
	await expect(place.locator('[data-changer="task"]')).toContainText('Operator');
	const from = place.locator('[data-from="operator.acknowledged"]');
	await open(from);
	await expect(from).toContainText('No message tells it: somebody acknowledges');
	expect(await findings(operate)).toEqual([]);
	await picture(operate, 'operate-why-tree');
	await operate.setViewportSize({ width: 390, height: 844 });
	expect(await overflow(operate)).toBe(0);
	expect(await smallTargets(operate)).toEqual([]);

	// As it was when it was asked, until it is asked again: then what is open is, too.
	await acknowledge(watch);
	await expect(placed).toContainText('✕');
	await dialog.getByRole('button', { name: 'Ask again' }).click();
	// It may have begun by then: what is asked of it now is when it is done.
	await expect(dialog.locator(':is([data-about="precondition"] li[data-holds="true"], [data-about="goal"])').first()).toBeVisible();
	await expect(dialog.locator('[data-about="precondition"] li[data-holds="false"]')).toHaveCount(0);
});

test('a measured variable leads to its message, its stages, and its trace', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, '/state?variable=robot.pose');
	await state.getByRole('button', { name: 'Trace of Pose of the robot' }).click();
	const trace = state.getByTestId('trace');
	const message = trace.locator('[data-pipeline="/ur10/state"]');
	await expect(message).toContainText('heard');
	await expect(message.locator('[data-stage=""]')).toContainText('joint_positions: [');
	await expect(message.locator('[data-stage="discretise"]')).toContainText('pose: ');
	await expect(message.locator('[data-stage="remember"]'), 'it does not bear on the pose').toHaveCount(0);
	await expect(trace.locator('[data-step="value"]')).toContainText('robot.pose');
	await expect(trace.locator('[data-reader^="ability robot.move_to_position"]').first()).toBeVisible();
	expect(await findings(state)).toEqual([]);
	await picture(state, 'state-trace');
	await state.setViewportSize({ width: 390, height: 844 });
	expect(await overflow(state)).toBe(0);
});

test('the trace of an output says who wrote it and follows what is sent', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, '/state?variable=operator.requested_pair');
	await state.getByRole('button', { name: 'Trace of Task of the operator' }).click();
	const trace = state.getByTestId('trace');
	await expect(trace.locator('[data-step="origin"]')).toContainText('by Place bolt pair');
	const sent = trace.locator('[data-step="out"] [data-pipeline="/operator/task"]');
	await expect(sent).toContainText('requested_pair: bolt_pair');
	const before = await trace.locator('[data-step="value"] strong').innerText();
	await acknowledge(watch);
	await expect(trace.locator('[data-step="value"] strong')).not.toHaveText(before);
});
