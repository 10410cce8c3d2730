import { acknowledge, done, picture, takeControl, tightenings, values, variable } from '../../station/seen.ts';
import { EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'devices that come and go', byItself: false });

test('silent devices make values unknown and name the topics awaited; when they speak again, work goes on @long', async ({
	station,
	operate,
	state,
	browse,
	watch
}) => {
	test.setTimeout(150_000);
	await expect(variable(state, 'robot.pose')).toContainText('awaits /ur10/state');
	const first = station.emulate();
	const start = operate.getByRole('button', { name: 'Start production' });
	await expect(variable(state, 'robot.pose')).toHaveAttribute('data-value', 'home', { timeout: 30_000 });

	// Nothing moves until a person has started production.
	await expect(start).toBeVisible({ timeout: 30_000 });
	await expect(done(watch)).toHaveCount(0);
	await takeControl(operate);
	await start.click();
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'started');
	await expect(start).toBeHidden();
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 30_000 });

	const ros = await browse(EVA, '/ros');
	await first.kill();
	for (const [name, topic] of [
		['robot.pose', '/ur10/state'],
		['nutrunner.tool_is_idle', '/smart_nutrunner/state']
	] as const) {
		await expect(variable(state, name)).toHaveAttribute('data-value', 'unknown');
		await expect(variable(state, name)).toContainText(`awaits ${topic}`);
		await expect(ros.locator(`[data-row="${topic}"] [data-standing]`)).toHaveAttribute('data-standing', /gone|stale/);
	}
	const robot = state.getByRole('button', { name: /^Robot UR10/ });
	await expect(robot).toContainText('Not heard');
	await picture(operate, 'operate-devices-silent');

	// Who died without a word is on the network until its lease ends, and the new devices wait for that.
	station.emulate();
	await expect(variable(state, 'robot.pose')).not.toHaveAttribute('data-value', 'unknown', { timeout: 30_000 });
	await expect(robot).not.toContainText('Not heard');
	const before = await tightenings(operate);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 30_000 });
	await acknowledge(watch);
	await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBeGreaterThan(before);
});

test('somebody moves the robot by hand while it works, and work goes on @long', async ({ station, operate, state, watch }) => {
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	const before = await tightenings(operate);
	await acknowledge(watch);
	await expect(variable(state, 'robot.pose')).not.toHaveAttribute('data-value', 'home');
	const poses = await values(state, 'robot.pose');
	await station.byHand('robot.pose := home');
	await expect.poll(poses).toContain('home');

	// It is led back to its work, whatever it was about to do, and the pair that was placed is tightened.
	await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBeGreaterThan(before);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	const second = await tightenings(operate);
	await acknowledge(watch);
	await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBeGreaterThan(second);
});
