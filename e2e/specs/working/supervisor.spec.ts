import { findings, overflow } from '../../station/barriers.ts';
import { restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('the guards that the supervisor adds stand apart, each with the specification it comes from', async ({
	operate,
	watch
}) => {
	await restsOnPerson(operate, watch);
	const panel = operate.getByRole('region', { name: 'Supervisor' });
	await expect(panel.getByTestId('supervisor')).toHaveText(
		/^22\s512 states can be reached, 17\s712 of them with the supervisor\.\s*$/
	);
	await panel.getByText('6 guards added by it').click();
	const guard = panel.locator('[data-guard="robot.move_to_position(position)"]');
	await expect(guard).toContainText('robot.move_to_position(position), for all position in bolt_pair only when');
	await expect(guard.locator('code.condition')).toHaveText(
		'operator.requested_pair != position and (bolts[position] != placed or nutrunner.run_nut.executing)'
	);
	await expect(guard).toContainText('because of no_standing_tool_on_placed_bolts(position)');
	await guard.getByText('Written out').click();
	await expect(guard.locator('details code').first()).toHaveText(
		'operator.requested_pair != bolt_pair_1 and (bolts[bolt_pair_1] != placed or nutrunner.run_nut.executing)'
	);
	expect(await findings(operate)).toEqual([]);
	for (const width of [1440, 768, 320]) {
		await operate.setViewportSize({ width, height: 900 });
		expect(await overflow(operate), `pixels to the right of a screen of ${width}`).toBe(0);
	}
});
