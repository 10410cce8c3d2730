import { restsOnPerson, signOut, takeControl } from '../station/seen.ts';
import { expect, test } from '../station/test.ts';

test('a demonstration says that it is one, wherever one acts, and asks before it begins again', async ({
	operate,
	watch,
	station
}) => {
	await restsOnPerson(operate, watch);
	await expect(operate.getByTestId('demonstration')).toContainText('The devices are emulated; nothing real moves.');
	await expect(operate.getByTestId('who')).toContainText('Demonstration engineer');
	await takeControl(operate);
	await operate.goto(`${station.url}/journal`);
	const taken = operate.locator('tr[data-record]').filter({ hasText: 'Took control' }).first();
	await expect(taken).toContainText('Demonstration');
	await expect(operate.getByTestId('demonstration')).toBeVisible();

	await signOut(operate);
	await operate.getByRole('button', { name: 'Open the demonstration' }).click();
	await expect(operate.getByTestId('demonstration')).toBeVisible();
});
