import type { Locator, Page } from '@playwright/test';
import { examine } from '../station/barriers.ts';
import { expect, test } from '../station/test.ts';

const SILENT = 'silent:robot';
const alarm = (page: Page): Locator => page.locator(`[data-alarm="${SILENT}"]`);

test('a device falls silent: its alarm is acknowledged, shelved, taken back and over, the same in two browsers', async ({
	station,
	operate,
	browse
}) => {
	await operate.goto(`${station.url}/alarms`);
	const other = await browse(null, '/alarms');
	const stands = (state: string): Promise<unknown> =>
		Promise.all([operate, other].map((page) => expect(alarm(page)).toHaveAttribute('data-state', state)));

	await station.fault('robot silent');
	await stands('unacknowledged');
	await expect(alarm(other)).toContainText('Nothing is heard on 2 topics');
	await expect(alarm(other)).toContainText(/” waits?\b|without it/);
	await expect(alarm(other)).toContainText('Check that the node of Robot UR10 runs');
	await expect(alarm(other).getByRole('link', { name: 'Topic /ur10/state' })).toHaveAttribute('href', /topic=%2Fur10/);

	await alarm(operate).getByRole('button', { name: 'Acknowledge' }).click();
	await stands('acknowledged');

	await alarm(operate).getByRole('button', { name: 'Shelve' }).click();
	const dialog = operate.getByRole('dialog');
	await dialog.getByLabel('For how long').selectOption('1 hour');
	await dialog.getByLabel('Reason').fill('Its cable is changed');
	await dialog.getByRole('button', { name: 'Shelve' }).click();
	await stands('shelved');
	// In the last hour of a day it ends on the next one.
	await expect(alarm(other)).toContainText(/until (\d+ \w+, )?\d\d:\d\d:\d\d: Its cable is changed/);

	// What is shown stands in the address, so that it can be sent to somebody and comes back.
	await operate.getByLabel('State').selectOption({ label: 'shelved (1)' });
	await expect(operate).toHaveURL(/state=shelved/);
	await operate.reload();
	await expect(alarm(operate)).toBeVisible();
	await operate.getByRole('button', { name: 'Show all' }).click();
	await examine(operate, 'alarms');

	await alarm(other).getByRole('button', { name: 'Tell it again' }).click();
	await stands('unacknowledged');
	await station.fault('clear');
	await stands('returned');
	await alarm(other).getByRole('button', { name: 'Acknowledge' }).click();
	await expect(alarm(operate)).toHaveCount(0);
	await expect(other.locator(`[data-earlier="${SILENT}"]`).first()).toContainText('Demonstration');
});
