import { examine } from '../../station/barriers.ts';
import { restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

/** The server prepares the model, then simulates, with what the machine has to spare. */
const SIMULATED = { timeout: 60_000 };

test('how the station would go on is simulated from now and from a record, and nothing of it happens @long', async ({
	operate,
	watch,
	station
}) => {
	await restsOnPerson(operate, watch);
	const requested = operate.locator('[data-variable="operator.requested_pair"]');
	const before = await requested.getAttribute('data-value');
	await operate.getByRole('link', { name: 'What-if' }).click();
	const main = operate.locator('main');

	await test.step('from the station as it is', async () => {
		await main.getByLabel('For how many seconds').fill('30');
		await main.getByRole('button', { name: 'Simulate' }).click();
		await expect(main.getByRole('heading', { name: 'What would happen' })).toBeVisible(SIMULATED);
		await expect(main).toContainText('30 seconds simulated');
		// In simulated time people do what they are asked, so bolts are placed and tightened.
		await expect(main.getByRole('table', { name: 'Runs of abilities' })).toContainText('Run the nutrunner');
		await expect(main.locator('.lanes .bar')).not.toHaveCount(0);
		await expect(main.getByRole('listitem').filter({ hasText: 'Tighten bolt pair' })).not.toHaveCount(0);
	});

	await test.step('from a record of the past', async () => {
		await main.getByLabel('A record of its history').check();
		await main.getByLabel('Number of the record').fill('1000000000');
		await main.getByRole('button', { name: 'Simulate' }).click();
		await expect(main.getByRole('alert')).toContainText('no such record', SIMULATED);
		await main.getByLabel('Number of the record').fill('1');
		await main.getByLabel('For how many seconds').fill('5');
		await main.getByRole('button', { name: 'Simulate' }).click();
		await expect(main).toContainText('5 seconds simulated', SIMULATED);
		await expect(main.getByRole('alert')).toBeEmpty();
	});

	await examine(operate, 'what-if');
	await operate.goto(station.url);
	await expect(requested).toHaveAttribute('data-value', before ?? '');
});
