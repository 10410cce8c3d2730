import { findings, overflow } from '../station/barriers.ts';
import { restsOnPerson } from '../station/seen.ts';
import { expect, test } from '../station/test.ts';

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
	const guard = panel.locator('[data-guard="robot.move_to_position(bolt_pair_1)"]');
	await expect(guard.locator('code')).toHaveText(
		'operator.requested_pair != bolt_pair_1 and (bolts[bolt_pair_1] != placed or nutrunner.run_nut.executing)'
	);
	await expect(guard).toContainText('because of no_standing_tool_on_placed_bolts(bolt_pair_1)');
	expect(await findings(operate)).toEqual([]);
	for (const width of [1440, 768, 320]) {
		await operate.setViewportSize({ width, height: 900 });
		expect(await overflow(operate), `pixels to the right of a screen of ${width}`).toBe(0);
	}
});
