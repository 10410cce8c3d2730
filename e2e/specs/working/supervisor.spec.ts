import { findings, overflow } from '../../station/barriers.ts';
import { expect, test } from '../../station/test.ts';

test('the guards that the supervisor adds stand apart, each with the specification it comes from', async ({ browse }) => {
	const model = await browse(null, '/model?panel=guards');
	const panel = model.getByRole('region', { name: 'What the supervisor adds' });
	await expect(panel.getByTestId('supervisor')).toHaveText(
		/^In the station that runs: 22\s512 states can be reached, 17\s712 of them with the supervisor\.\s*$/,
		{ timeout: 60_000 }
	);
	await expect(panel).toContainText('It adds to the guards of 6 abilities');
	await expect(panel.locator('[data-guard]')).toHaveCount(2);
	const guard = panel.locator('[data-guard="robot.move_to_position(position)"]');
	await expect(guard).toContainText('for all position in bolt_pair');
	await expect(guard.locator('code.condition')).toHaveText(
		'operator.requested_pair != position and (bolts[position] != placed or nutrunner.run_nut.executing)'
	);
	await expect(guard).toContainText('no_standing_tool_on_placed_bolts(position)');
	await guard.getByText('Written out').click();
	await expect(guard.locator('details code').first()).toHaveText(
		'operator.requested_pair != bolt_pair_1 and (bolts[bolt_pair_1] != placed or nutrunner.run_nut.executing)'
	);
	expect(await findings(model)).toEqual([]);
	for (const width of [1440, 768, 320]) {
		await model.setViewportSize({ width, height: 900 });
		expect(await overflow(model), `pixels to the right of a screen of ${width}`).toBe(0);
	}
});
