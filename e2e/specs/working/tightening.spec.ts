import { PAIRS, acknowledge, completed, done, picture, restsOnPerson, variable } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

/** An engine that others have begun may take two rounds before the pairs of the next are all this test's. */
const ROUNDS = PAIRS.length + 2;

test('the operator acknowledges on the watch and three bolt pairs are tightened', async ({
	operate,
	state,
	watch,
	complaints
}) => {
	const block = (ability: string, ...status: string[]) =>
		operate.locator(status.map((each) => `[data-step="${ability}"][data-status="${each}"]`).join(', ')).first();
	const place = () => operate.getByRole('region', { name: 'Plan' }).boundingBox();
	const tightened = new Set<string>();
	await restsOnPerson(operate, watch);
	const engines = await completed(operate, 'new_engine');
	await picture(watch, 'watch-192');
	await picture(operate, 'operate-1440');
	const before = await place();

	for (let round = 1; round <= ROUNDS && tightened.size < PAIRS.length; round++) {
		const counts = new Map<string, number>();
		for (const pair of PAIRS) counts.set(pair, await completed(operate, `tighten_bolt_pair(${pair})`));
		const built = await completed(operate, 'new_engine');
		const pair = await acknowledge(watch);
		// Looked for from now on: the robot may stand there for a moment only, while something else is looked at.
		const arrives = expect(variable(state, 'robot.pose')).toHaveAttribute('data-value', pair);

		// The plan runs: the tool is commanded to turn, the robot goes to the pair, and the picture of the plan says so.
		await expect(variable(state, 'nutrunner.run_tool_forward')).toHaveAttribute('data-value', 'true');
		await expect(block('nutrunner.run_nut', 'running')).toBeVisible();
		await picture(operate, `operate-running-${round}`);
		expect(await place(), 'the plan changes, its place on the page does not').toEqual(before);
		await arrives;
		await expect(block(`robot.move_to_position(${pair})`, 'running', 'done')).toBeVisible();

		// The last pair of an engine is seen tightened only for the moment until the next engine comes in.
		await expect
			.poll(() => completed(operate, `tighten_bolt_pair(${pair})`), { timeout: 60_000, intervals: [100] })
			.toBe((counts.get(pair) ?? 0) + 1);
		tightened.add(pair);
		await restsOnPerson(operate, watch);
		if ((await completed(operate, 'new_engine')) === built)
			await expect(variable(state, `bolts[${pair}]`)).toHaveAttribute('data-value', 'tightened');
	}

	expect([...tightened].sort()).toEqual([...PAIRS]);
	// All three are tightened, so a new engine comes in and the work goes on by itself.
	expect(await completed(operate, 'new_engine')).toBeGreaterThan(engines);
	await expect(done(watch)).toBeVisible();
	expect(complaints).toEqual([]);
});
