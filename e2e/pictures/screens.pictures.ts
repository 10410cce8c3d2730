/** The operator's screens, at the desk, on a tablet and on a wrist, in both themes: `docs/screens`. */
import type { Page } from '@playwright/test';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { done, restsOnPerson, takeControl } from '../station/seen.ts';
import { expect, test } from '../station/test.ts';

const FOLDER = join(import.meta.dirname, '../../docs/screens');
const SCREENS = [
	[1440, 900],
	[768, 1024],
	[192, 192]
] as const;

/** Takes pictures of a page as it is now. */
async function take(page: Page, name: string): Promise<void> {
	for (const colorScheme of ['light', 'dark'] as const) {
		await page.emulateMedia({ colorScheme });
		for (const [width, height] of SCREENS) {
			await page.setViewportSize({ width, height });
			await page.waitForTimeout(300);
			await page.screenshot({ path: join(FOLDER, `${name}-${width}-${colorScheme}.png`) });
		}
	}
	await page.emulateMedia({ colorScheme: 'light' });
	await page.setViewportSize({ width: 1440, height: 900 });
}

test('all screens', async ({ station, operate, watch, browse }) => {
	mkdirSync(FOLDER, { recursive: true });
	await restsOnPerson(operate, watch);
	await done(watch).tap();
	await operate.waitForTimeout(1500);
	await take(operate, 'operate');
	await restsOnPerson(operate, watch);
	await take(watch, 'watch');
	for (const [name, settled] of [
		['state', '[data-row]'],
		['history', 'main'],
		['ros', '[data-row]']
	] as const) {
		const page = await browse(null, `/${name}`);
		await page.locator(settled).first().waitFor();
		await page.waitForTimeout(6000); // rates, and what a minute keeps
		await take(page, name);
		await page.close();
	}

	await station.fault('robot silent');
	const alarms = await browse(null, '/alarms');
	await alarms.locator('[data-alarm="silent:robot"]').waitFor();
	await take(alarms, 'alarms');
	await alarms.close();
	await take(operate, 'operate-alarm');
	await station.fault('clear');
	await expect(operate.getByTestId('mode')).toContainText('Automatic');

	await takeControl(operate);
	await operate.getByRole('button', { name: 'Hold', exact: true }).click();
	await expect(operate.getByTestId('mode')).toContainText('Hold');
	await station.byHand('robot.pose := unknown');
	await operate.goto(`${station.url}/restart`);
	await operate.getByRole('button', { name: 'Enter restart mode' }).click();
	await operate.getByRole('dialog').getByLabel('Reason').fill('It was pushed');
	await operate.getByRole('dialog').getByRole('button', { name: 'Enter restart mode' }).click();
	await operate.locator('[data-offer]').first().waitFor({ timeout: 30_000 });
	await take(operate, 'restart');

	await operate.goto(`${station.url}/state?kind=estimated`);
	await operate.locator('[data-row]').first().getByRole('button', { name: /^Correct…/ }).click();
	const dialog = operate.getByRole('dialog');
	await dialog.getByRole('radio').last().check();
	await dialog.getByRole('button', { name: 'Show what follows' }).click();
	await dialog.getByTestId('follows').waitFor();
	await take(operate, 'correct');
});
