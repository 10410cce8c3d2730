import type { Locator, Page } from '@playwright/test';
import { examine, findings } from '../../station/barriers.ts';
import { expect, test } from '../../station/test.ts';

const SILENT = 'silent:robot';
const alarm = (page: Page): Locator => page.locator(`[data-alarm="${SILENT}"]`);
/** All about it, beside the list once it is chosen. */
const detail = (page: Page): Locator => page.locator(`[data-of="${SILENT}"]`);
const choose = (page: Page): Promise<void> => alarm(page).getByRole('button').first().click();

test('a device falls silent: its alarm is acknowledged, shelved, taken back and over, the same in two browsers', async ({
	station,
	operate,
	browse
}) => {
	await operate.goto(`${station.url}/alarms`);
	const other = await browse(null, '/alarms');
	const stands = (state: string): Promise<unknown> =>
		Promise.all([operate, other].map((page) => expect(alarm(page)).toHaveAttribute('data-state', state)));

	// What waits for it is said only of a station at work.
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'started', { timeout: 60_000 });
	await station.fault('robot silent');
	await stands('unacknowledged');
	await expect(alarm(other)).toContainText('Nothing heard from Robot UR10');
	await expect(alarm(other)).toContainText(/” waits?\b|without it/);
	await choose(other);
	await expect(detail(other)).toContainText('Check the power and the network of Robot UR10, and that its ROS node runs.');
	await expect(detail(other)).toContainText('How it came about');
	await expect(detail(other).getByRole('link', { name: 'Its 2 topics' })).toHaveAttribute('href', '/ros?show=wrong');

	await alarm(operate).getByRole('button', { name: 'Acknowledge' }).click();
	await stands('acknowledged');

	await choose(operate);
	const shelve = async (): Promise<void> => {
		await detail(operate).getByRole('button', { name: 'Shelve…' }).click();
		const dialog = operate.getByRole('dialog');
		await dialog.getByLabel('For how long').selectOption('1 hour');
		await dialog.getByLabel('Reason').fill('Its cable is changed');
		await dialog.getByRole('button', { name: 'Shelve' }).click();
	};
	await shelve();
	const done = operate.getByTestId('toasts');
	await expect(done).toContainText('The alarm is shelved until about');
	await done.getByRole('button', { name: 'Take back' }).click();
	await expect(done).toBeEmpty();
	await stands('unacknowledged');
	await shelve();
	const setAside = (page: Page): Promise<void> => page.getByRole('button', { name: /^Set aside/ }).click();
	for (const page of [operate, other]) await setAside(page);
	await stands('shelved');
	// In the last hour of a day it ends on the next one.
	await choose(other);
	await expect(detail(other)).toContainText(/until (\d+ \w+, )?\d\d:\d\d:\d\d: Its cable is changed/);

	// What is shown stands in the address, so that it can be sent to somebody and comes back.
	await operate.getByRole('button', { name: 'Filter' }).click();
	await operate.getByLabel('State', { exact: true }).selectOption({ label: 'shelved (1)' });
	await expect(operate).toHaveURL(/state=shelved/);
	await operate.reload();
	await expect(alarm(operate)).toBeVisible();
	await operate.getByRole('button', { name: 'Show all' }).click();

	await detail(other).getByRole('button', { name: 'Tell it again' }).click();
	for (const page of [operate, other]) await page.getByRole('button', { name: /^Standing/ }).click();
	await stands('unacknowledged');
	await examine(operate, 'alarms');
	await operate.setViewportSize({ width: 1440, height: 900 });
	await station.fault('clear');
	await stands('returned');
	await alarm(other).getByRole('button', { name: 'Acknowledge' }).click();
	await expect(alarm(operate)).toHaveCount(0);
	await expect(other.locator(`[data-earlier="${SILENT}"]`).first()).toContainText('Demonstration');

	// How many came in each hour, drawn and as a table.
	await operate.getByRole('button', { name: 'Alarms per hour' }).click();
	const drawer = operate.getByRole('dialog', { name: 'Alarms per hour' });
	await expect(drawer.getByRole('img', { name: /^\d+ alarms? in the last 8 hours/ }).locator('canvas')).toBeVisible();
	await examine(operate, 'alarms-per-hour');
	await operate.setViewportSize({ width: 1440, height: 900 });
	await drawer.getByRole('button', { name: 'as table' }).click();
	const hours = drawer.getByRole('row').filter({ has: operate.getByRole('link') });
	await expect(hours).toHaveCount(8);
	const counts = await hours.locator('td:nth-child(2)').allInnerTexts();
	// It fell silent in this hour, or at the end of the one before.
	expect(Number(counts[0]) + Number(counts[1])).toBeGreaterThan(0);
	expect(await findings(operate)).toEqual([]);
	await drawer.getByRole('button', { name: '24 h' }).click();
	await expect(hours).toHaveCount(24);
	await operate.keyboard.press('Escape');
	await expect(operate.getByRole('button', { name: 'Alarms per hour' })).toBeFocused();
});
