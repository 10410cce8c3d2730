import { examine } from '../station/barriers.ts';
import { acknowledge, done, picture, restsOnPerson, takeControl, tightenings } from '../station/seen.ts';
import { expect, test } from '../station/test.ts';

test('held, into restart mode and out of it, each by an act of its own, and work goes on', async ({ operate, watch }) => {
	const mode = operate.getByTestId('mode');
	const restart = operate.getByRole('region', { name: 'Restart' });
	const press = (name: string) => operate.getByRole('button', { name, exact: true });
	await restsOnPerson(operate, watch);
	await expect(restart).toBeHidden(); // as long as the station works by itself
	const before = await tightenings(operate);
	await takeControl(operate);

	await test.step('Hold is one press, and a second on the same place does no harm', async () => {
		await press('Hold').click();
		await expect(mode).toContainText('Hold');
		await press('Hold').click({ force: true });
		await expect(press('Continue')).toBeVisible();
		await expect(restart).toContainText('Nothing is started');
	});

	await test.step('in restart mode operations wait, and there is no way on but out of it', async () => {
		await press('Enter restart mode').click();
		await expect(mode).toContainText('Restart');
		await expect(press('Continue')).toBeHidden();
		await acknowledge(watch);
		await operate.waitForTimeout(2000);
		await expect(operate.locator('[data-status="running"]')).toHaveCount(0);
		expect(await tightenings(operate)).toBe(before);
		await picture(operate, 'operate-restart');
	});

	await test.step('leaving it pauses', async () => {
		await press('Leave restart mode').click();
		await expect(mode).toContainText('Paused');
		await operate.waitForTimeout(1000);
		await expect(mode).toContainText('Paused');
	});

	await test.step('and Continue goes on', async () => {
		await press('Continue').click();
		await expect(mode).toContainText('Automatic');
		await expect(restart).toBeHidden();
		await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBe(before + 1);
	});
});

test('the page can be read and pressed in restart mode', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await takeControl(operate);
	await operate.getByRole('button', { name: 'Hold', exact: true }).click();
	await operate.getByRole('button', { name: 'Enter restart mode' }).click();
	await expect(operate.getByTestId('mode')).toContainText('Restart');
	await examine(operate, 'restart');
	await operate.setViewportSize({ width: 1440, height: 900 });
	await operate.getByRole('button', { name: 'Leave restart mode' }).click();
	await operate.getByRole('button', { name: 'Continue', exact: true }).click();
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
});
