/** The screens in both themes, at the desk, on a tablet and on a phone; ten of them for `docs/screens`. */
import type { Page } from '@playwright/test';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { done, restsOnPerson, takeControl } from '../station/seen.ts';
import { ADA, EVA } from '../station/station.ts';
import { expect, test } from '../station/test.ts';

/** Where the documentation has its pictures, and where all others go. */
const DOCS = join(import.meta.dirname, '../../docs/screens');
const REST = join(import.meta.dirname, '../artefacts/screens');
/** Those that the documentation shows, in light and on a desk or a wrist. */
const SHOWN = new Set(['operate', 'wall', 'restart', 'correct', 'alarms', 'history', 'orders', 'model', 'pipelines'].map((name) => `${name}-1440-light`)).add('watch-192-light');
const SCREENS = [
	[1440, 900],
	[768, 1024],
	[390, 844]
] as const;
const WRIST = [
	[192, 192],
	[390, 844]
] as const;

/** Takes pictures of a page as it is now. */
async function take(page: Page, name: string, screens: readonly (readonly [number, number])[] = SCREENS): Promise<void> {
	const before = page.viewportSize();
	for (const colorScheme of ['light', 'dark'] as const) {
		await page.emulateMedia({ colorScheme });
		for (const [width, height] of screens) {
			await page.setViewportSize({ width, height });
			await page.waitForTimeout(300);
			const each = `${name}-${width}-${colorScheme}`;
			await page.screenshot({ path: join(SHOWN.has(each) ? DOCS : REST, `${each}.png`) });
		}
	}
	await page.emulateMedia({ colorScheme: 'light' });
	if (before !== null) await page.setViewportSize(before);
}

test('all screens', async ({ station, operate, watch, browse }) => {
	mkdirSync(REST, { recursive: true });
	await restsOnPerson(operate, watch);
	await done(watch).tap();
	await operate.waitForTimeout(1500);
	await take(operate, 'operate');
	await restsOnPerson(operate, watch);
	await take(watch, 'watch', WRIST);
	for (const [name, settled] of [
		['wall', 'main'],
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
	await operate.locator('main').getByRole('button', { name: /Choose a way back/ }).click();
	await operate.locator('[data-offer]').first().waitFor({ timeout: 30_000 });
	await take(operate, 'restart');

	await operate.goto(`${station.url}/state?kind=estimated`);
	await operate.locator('[data-row]').first().getByRole('button', { name: /^Correct…/ }).click();
	const dialog = operate.getByRole('dialog');
	await dialog.getByRole('radio').last().check();
	await dialog.getByTestId('follows').waitFor();
	await take(operate, 'correct');
});

test('the screens of engineers', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	for (const [name, address, settled] of [
		['model', '/model?entry=resources%2Frobot.yaml%23abilities%23move_to_position', '[role="tree"]'],
		['ability', '/model?ability=robot.move_to_position(home)&panel=runs', '[data-testid="by-itself"]'],
		['pipelines', '/pipelines?of=%2Fur10%2Fstate', '.svelte-flow__node'],
		['station', '/model?view=graph&thing=operation%3Aprepare_planning_scene', '[data-tied="near"]'],
		['check', '/model?panel=guards', '[data-guard]'],
		['review', '/review', '[data-testid="draft"][data-verdict="good"]']
	] as const) {
		const page = await browse(null, address);
		await page.locator(settled).first().waitFor({ timeout: 60_000 });
		await page.waitForTimeout(3000); // what moves until it is laid out
		await take(page, name);
		await page.close();
	}

	const page = await browse(null, '/what-if?simulation');
	await page.getByRole('combobox', { name: 'Speed' }).selectOption('10×', { timeout: 60_000 });
	await page.getByRole('button', { name: 'Play' }).click();
	const seconds = async (): Promise<number> => Number(await page.getByTestId('simulated-time').getAttribute('data-seconds'));
	await expect.poll(seconds, { timeout: 60_000 }).toBeGreaterThan(20);
	await page.getByRole('button', { name: 'Stop the clock' }).click();
	await take(page, 'what-if');
});

test.describe('where people are known', () => {
	test.use({ shared: 'people', byItself: false, devices: true, people: 'everybody' });

	test('orders, and the screens of administrators', async ({ browse }) => {
		const eva = await browse(EVA, '/orders');
		await takeControl(eva);
		const form = eva.getByRole('dialog', { name: 'New order' });
		for (const [description, priority] of [['Engine 4711', '0'], ['Engine 4712', '5'], ['Engine 4713', '1']] as const) {
			await eva.getByRole('button', { name: 'New order' }).click();
			await form.getByLabel('Description').fill(description);
			await form.getByLabel('Priority').fill(priority);
			await form.getByRole('button', { name: 'Add order' }).click();
			await eva.locator('[data-order]').filter({ hasText: description }).waitFor();
		}
		await eva.waitForTimeout(12_000); // until their order is computed
		await take(eva, 'orders');
		for (const name of ['users', 'webhooks', 'backups', 'storage']) {
			const page = await browse(ADA, `/${name}`);
			await page.locator('main h2').first().waitFor();
			await page.waitForTimeout(1500);
			await take(page, name);
			await page.close();
		}
	});
});
