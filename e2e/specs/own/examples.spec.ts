/** The example stations: opened from an empty station, looked at in all pages of the model, copied from, and begun with. */
import type { Locator, Page } from '@playwright/test';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import { expression, form } from '../../station/editor.ts';
import { ADA, ERIK, INA, Station, VERA } from '../../station/station.ts';
import { expect, test as base } from '../../station/test.ts';

/** A station that has nothing but its name. */
const test = base.extend({
	station: async ({}, use, info) => {
		const folder = mkdtempSync(join(tmpdir(), 'model-'));
		const model = join(folder, 'north_gate');
		mkdirSync(model);
		writeFileSync(join(model, 'station.yaml'), 'name: north_gate\n');
		const logs = join(import.meta.dirname, '../../artefacts/logs', `examples-${info.testId}`);
		const station = await Station.start({ byItself: false, devices: true, people: [ADA, ERIK, INA, VERA], logs, model });
		await use(station);
		await station.stop();
		rmSync(folder, { recursive: true });
	}
});

const TRUCK = 'truck_engine_station';
const TITLE = 'Truck engine station';
const banner = (page: Page): Locator => page.getByTestId('example');
const dialog = (page: Page): Locator => page.getByRole('dialog');
const row = (page: Page, ...steps: string[]): Locator => page.locator(`[role="treeitem"][data-id="${steps.join('#')}"]`);
const rail = (page: Page, name: string): Locator => page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name, exact: true });
const toasts = (page: Page): Locator => page.getByTestId('toasts');

test('an example is opened in one press from an empty station, looked at in all pages, and left', async ({ browse, complaints }) => {
	const page = await browse(INA, '/model');
	const first = page.getByRole('region', { name: 'Begin with an example' });
	await expect(first.locator('li')).toHaveCount(5);
	await expect(first.locator(`[data-example="${TRUCK}"]`)).toContainText('8 resources, 22 abilities, 11 operations');
	await examine(page, 'examples-first');
	await first.getByRole('link', { name: TITLE }).click();

	// Model: what it is, its parts, and nothing that can be written in.
	await expect(banner(page)).toContainText(`You look at the example station “${TITLE}”. It cannot be changed here.`);
	await expect(page).toHaveURL(`/model?example=${TRUCK}`);
	await expect(expression(page, 'States of rest')).toHaveAttribute('aria-readonly', 'true');
	await expect(form(page).getByRole('button', { name: 'Add…' })).toHaveCount(0);
	for (const name of [/^Undo/, /^Redo/]) await expect(page.getByRole('button', { name })).toHaveCount(0);
	await expect(page.getByRole('link', { name: 'Review changes', exact: true }).and(page.locator('main a'))).toHaveCount(0);
	await expect(page.getByRole('tab', { name: 'Problems' })).toBeVisible();
	for (const name of ['Tests', 'Changes']) await expect(page.getByRole('tab', { name })).toHaveCount(0);
	await examine(page, 'examples-model');
	await row(page, 'resources/robot.yaml').click();
	await expect(form(page).getByRole('heading').first()).toContainText('robot');
	await page.getByRole('button', { name: 'Usages' }).first().click();
	await expect(page.getByText(/^Used (at|in) \d+/).or(page.getByText(/\d+ places/)).first()).toBeVisible();
	await page.getByRole('button', { name: 'Graph' }).click();
	await expect(page).toHaveURL(/view=graph.*example=truck_engine_station/);
	await expect(page.getByRole('region', { name: 'Graph' })).toContainText('robot');

	// Operations and Pipelines of the same example, by what leads there.
	await page.getByRole('button', { name: 'Form' }).click();
	await page.getByLabel('Search: name or title').fill('tighten_bolt_pair');
	await row(page, 'operations.yaml', 'tighten_bolt_pair').click();
	await form(page).getByRole('link', { name: 'See it in the order of operations' }).click();
	await expect(page).toHaveURL(`/operations?example=${TRUCK}`);
	await expect(banner(page)).toContainText(TITLE);
	await expect(page.locator('[data-operation]').first()).toBeVisible();
	await expect(page.locator('main')).not.toContainText('not in the station yet');
	await expect(page.getByRole('button', { name: 'Operation', exact: true })).toHaveCount(0);
	await expect(page.getByRole('button', { name: 'Gantt' })).toHaveCount(0);
	await page.locator('[data-operation]').first().click();
	await page.getByRole('complementary', { name: 'The chosen operation' }).getByRole('link', { name: /operations\.yaml, line/ }).click();
	await expect(page).toHaveURL(/\/model\?file=operations\.yaml.*example=truck_engine_station/);

	await page.goto(`/pipelines?example=${TRUCK}`);
	await expect(banner(page)).toContainText(TITLE);
	await page.getByRole('navigation', { name: 'Pipelines' }).getByRole('link').nth(1).click();
	await expect(page).toHaveURL(/\/pipelines\?of=.*example=truck_engine_station/);
	await expect(page.locator('.shown-pipeline')).toBeVisible();
	await expect(page.locator('[data-stage-kind]')).toHaveCount(0);
	await expect(page.locator('main')).not.toContainText('only in the draft');
	await expect(page.getByRole('button', { name: 'Topic', exact: true })).toHaveCount(0);
	await examine(page, 'examples-pipelines');

	// The rail leads back to the own station, which is as it was.
	await rail(page, 'Model').click();
	await expect(page).toHaveURL('/model');
	await expect(banner(page)).toHaveCount(0);
	await expect(row(page, 'resources/robot.yaml')).toHaveCount(0);
	await expect(first).toBeVisible();
	expect(complaints).toEqual([]);
});

test('a part is copied out of an example; the station begins with one, and undo takes that back', async ({ browse, complaints }) => {
	const page = await browse(INA, '/model');
	await expect(page.getByRole('tree')).toBeVisible();
	// Wherever one is, the examples are a few letters away.
	await page.keyboard.press('Control+k');
	await page.getByRole('combobox').fill('example');
	await page.keyboard.press('Enter');
	await dialog(page).getByRole('link', { name: 'A single bolt' }).click();
	await expect(banner(page)).toContainText('A single bolt');
	const robot = row(page, 'resources/robot.yaml');
	await robot.click();
	await expect(robot).toHaveAttribute('aria-selected', 'true');
	await robot.focus();
	await expect(async () => {
		await page.keyboard.press('Control+c');
		await expect(page.getByText('robot copied as YAML')).toBeVisible({ timeout: 1000 });
	}).toPass();
	await page.keyboard.press('Control+v');
	await banner(page).getByRole('link', { name: 'Back to your station' }).click();
	await expect(banner(page)).toHaveCount(0);
	await expect(robot).toHaveCount(0);
	await row(page, 'station.yaml').focus();
	await page.keyboard.press('Control+v');
	await expect(robot).toHaveAttribute('aria-selected', 'true');

	// What would be lost is said before.
	await page.getByRole('button', { name: 'Examples…' }).click();
	await examine(page, 'examples-list');
	await dialog(page).getByRole('link', { name: 'Two robots and a buffer' }).click();
	await banner(page).getByRole('button', { name: 'Begin with it' }).click();
	await expect(dialog(page)).toContainText('It takes the place of all that is in your draft: 2 files.');
	await expect(dialog(page)).toContainText('resources/robot.yaml');
	await dialog(page).getByRole('button', { name: 'Begin with it' }).click();
	await expect(page).toHaveURL('/model');
	await expect(toasts(page)).toContainText('Begun with “Two robots and a buffer”');
	await expect(row(page, 'resources/robot_1.yaml')).toBeVisible();
	await expect(robot).toHaveCount(0);
	await expect(page.getByTestId('check')).toHaveAttribute('data-verdict', /good|warnings/, { timeout: 60_000 });
	await expect(form(page).getByLabel('Name', { exact: true })).toHaveValue('north_gate');
	// What was pasted before may still be told beside it.
	await toasts(page).locator('.toast', { hasText: 'Begun with' }).getByRole('button', { name: 'Take back' }).click();
	await expect(row(page, 'resources/robot_1.yaml')).toHaveCount(0);
	await expect(robot).toBeVisible();

	// Where nothing is lost nothing is asked.
	await page.getByRole('button', { name: /^Undo: / }).click();
	await expect(robot).toHaveCount(0);
	await page.getByRole('region', { name: 'Begin with an example' }).getByRole('link', { name: 'A single bolt' }).click();
	await banner(page).getByRole('button', { name: 'Begin with it' }).click();
	await expect(toasts(page)).toContainText('Begun with “A single bolt”');
	await expect(robot).toBeVisible();
	expect(complaints).toEqual([]);
});

test('who is no engineer looks at examples and begins with none', async ({ browse }) => {
	const page = await browse(VERA, `/model?example=single_bolt`);
	await expect(banner(page)).toContainText('A single bolt');
	await expect(banner(page).getByRole('button', { name: 'Begin with it' })).toHaveCount(0);
	await page.goto('/model?example=nowhere');
	await expect(page.getByText('There is no example station “nowhere”.')).toBeVisible();
});
