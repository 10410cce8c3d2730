import { acknowledge, done, picture, restsOnPerson, takeControl, tightenings, variable } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('Pause starts nothing more, Continue goes on', async ({ operate, state, watch }) => {
	await restsOnPerson(operate, watch);
	const before = await tightenings(operate);
	await operate.getByRole('button', { name: 'Pause', exact: true }).click();
	await expect(operate.getByTestId('mode')).toContainText('Paused');
	// A hurried second press on the same place must not undo the first.
	await operate.getByRole('button', { name: 'Pause', exact: true }).click({ force: true });

	await acknowledge(watch);
	await expect(done(watch)).toHaveCount(0);
	await operate.waitForTimeout(2000);
	await expect(operate.getByTestId('mode')).toContainText('Paused');
	await expect(variable(state, 'nutrunner.run_tool_forward')).toHaveAttribute('data-value', 'false');
	await expect(operate.locator('[data-status="running"]')).toHaveCount(0);
	expect(await tightenings(operate)).toBe(before);
	await picture(operate, 'operate-paused');

	await takeControl(operate);
	await operate.getByRole('button', { name: 'Continue' }).click();
	await expect(operate.getByTestId('mode')).toContainText('Automatic');
	await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBe(before + 1);
});

test('an acknowledgement of a task that is gone completes no other', async ({ operate, watch, station }) => {
	await restsOnPerson(operate, watch);
	const before = await tightenings(operate);
	const task = await done(watch).getAttribute('data-task');
	const revision = Number(await done(watch).getAttribute('data-revision'));
	const again = (): Promise<number> =>
		operate.evaluate(
			async ([path, body]) => {
				const headers = { 'Content-Type': 'application/json' };
				return (await fetch(path, { method: 'POST', headers, body })).status;
			},
			[`${station.url}/api/v1/tasks/${task}/acknowledgement`, JSON.stringify({ revision })] as const
		);

	await acknowledge(watch);
	await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBe(before + 1);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	const next = await done(watch).getAttribute('data-task');
	expect([404, 409]).toContain(await again());
	await operate.waitForTimeout(1000);
	await expect(done(watch)).toHaveAttribute('data-task', next ?? '');
});

test('a refused acknowledgement is said in words', async ({ watch }) => {
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	// Somebody else acknowledges between the reading and the press: the answer that the server gives then.
	await watch.route('**/acknowledgement', (route) =>
		route.continue({ postData: JSON.stringify({ revision: 999_999 }) })
	);
	await done(watch).tap();
	await expect(watch.getByRole('alert')).toContainText('This task is gone');
});
