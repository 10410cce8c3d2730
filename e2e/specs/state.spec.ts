import { findings, smallTargets } from '../station/barriers.ts';
import { acknowledge, picture, restsOnPerson, takeControl, variable } from '../station/seen.ts';
import { expect, test } from '../station/test.ts';
import type { Locator, Page } from '@playwright/test';

const BOLTS = (pair: string): string => `bolts[${pair}]`;

/** Opens the correction of an estimate, chooses a value and has it shown what follows. */
async function lookAt(page: Page, name: string, value: string): Promise<Locator> {
	await page.locator(`[data-row="${name}"]`).getByRole('button', { name: /^Correct…/ }).click();
	const dialog = page.getByRole('dialog');
	await dialog.getByRole('radio', { name: value }).check();
	await dialog.getByRole('button', { name: 'Show what follows' }).click();
	await expect(dialog.getByTestId('follows')).toBeVisible();
	return dialog;
}

/** Asks the server for something as the page would. */
async function ask(page: Page, method: string, path: string, body: object): Promise<void> {
	const status = await page.evaluate(
		async ([method, path, body]) => {
			const headers = { 'Content-Type': 'application/json' };
			return (await fetch(`/api/v1/${path}`, { method, headers, body })).status;
		},
		[method, path, JSON.stringify(body)] as const
	);
	expect(status).toBeLessThan(300);
}

/** Takes control over, whoever has it, while a dialog is open. */
async function seize(page: Page): Promise<void> {
	const over = await page.evaluate(async () => {
		const { control } = (await (await fetch('/api/v1/station')).json()) as { control: { session: string } | null };
		return control?.session ?? null;
	});
	await ask(page, 'PUT', 'control-lock', { over, reason: 'It is my turn' });
	await expect(page.getByTestId('control')).toHaveAttribute('data-holder', 'you');
}

/** Says why and that it shall be, after what follows was seen. */
async function correct(dialog: Locator, reason: string): Promise<void> {
	await dialog.getByLabel('Reason').fill(reason);
	await dialog.getByRole('button', { name: 'Correct…', exact: true }).click();
	await dialog.getByRole('button', { name: 'Yes, correct it' }).click();
}

test('a variable is found by words of it, and seen to change @theme', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const state = await browse(null, '/state?kind=estimated');
	await expect(state.locator('[data-row]')).toHaveCount(3);
	await state.getByLabel('Search').fill('pair nowhere');
	await expect(state.getByText('No variable is like that.')).toBeVisible();

	await state.getByLabel('Search').fill('empty bolts');
	await expect(state.locator('[data-row]')).not.toHaveCount(0); // the one that a person is asked to place
	const before = await state.locator('[data-row]').count();
	const pair = await acknowledge(watch);
	await expect(state.locator('[data-row]')).toHaveCount(before - 1);
	await state.getByLabel('Search').fill(`PAIR bolts ${pair.at(-1)}`);
	await expect(state).toHaveURL(/kind=estimated/);
	await expect(variable(state, BOLTS(pair))).toHaveAttribute('data-value', /placed|tightened/);
	await expect(state.locator(`[data-row="${BOLTS(pair)}"]`)).toContainText(/operator.place_bolt_pair|nutrunner.run_nut/);

	await state.getByRole('button', { name: 'Show all' }).click();
	expect(await findings(state)).toEqual([]);
	await picture(state, 'state');
	for (const width of [768, 320]) {
		await state.setViewportSize({ width, height: 900 });
		expect(await smallTargets(state)).toEqual([]);
		await picture(state, `state-${width}`);
	}
});

test('an estimate is corrected after what follows was seen, and that is taken back @long', async ({ operate, watch, browse }) => {
	await restsOnPerson(operate, watch);
	const [state, other] = [await browse(null, '/state?kind=estimated'), await browse(null, '/state?kind=estimated')];
	const row = state.locator('[data-row]').filter({ has: state.locator('[data-value="empty"]') }).first();
	const name = (await row.getAttribute('data-row')) ?? '';
	await takeControl(state);

	await test.step('what is in the way is said beforehand, and each act is one of its own', async () => {
		const dialog = await lookAt(state, name, 'placed');
		await dialog.getByLabel('Reason').fill('It is in its hole');
		await expect(dialog.getByRole('button', { name: 'Correct…', exact: true })).toHaveAttribute('aria-disabled', 'true');
		await dialog.getByRole('button', { name: 'Enter restart mode' }).click();
		await expect(dialog).toContainText('The state has moved');
		await dialog.getByRole('button', { name: 'Look again' }).click();
		await expect(dialog).not.toContainText('The state has moved');
		await expect(dialog.getByTestId('follows')).toContainText('Violates');
		expect(await findings(state)).toEqual([]);
		await picture(state, 'correct');
		await correct(dialog, 'It is in its hole');
	});

	await test.step('everybody sees it, and who corrected it', async () => {
		for (const page of [state, other]) {
			await expect(variable(page, name)).toHaveAttribute('data-value', 'placed');
			await expect(page.getByTestId('last-correction')).toContainText('It is in its hole');
		}
	});

	await test.step('two who looked at the same state cannot both correct it', async () => {
		const [undo, dialog] = [state.getByRole('dialog'), await lookAt(other, name, 'tightened')];
		await state.getByTestId('last-correction').getByRole('button').click();
		await undo.getByRole('button', { name: 'Show what follows' }).click();
		await undo.getByLabel('Reason').fill('It was another pair');
		await dialog.getByLabel('Reason').fill('It is tight');
		await seize(other);
		// The second one's request is on its way while the first one takes the correction back.
		await other.route('**/api/v1/corrections', async (route) => {
			await seize(state);
			await undo.getByRole('button', { name: 'Take back…' }).click();
			await undo.getByRole('button', { name: 'Yes, take it back' }).click();
			await expect(variable(state, name)).toHaveAttribute('data-value', 'empty');
			await seize(other);
			await route.continue();
		});
		await dialog.getByRole('button', { name: 'Correct…', exact: true }).click();
		await dialog.getByRole('button', { name: 'Yes, correct it' }).click();
		await expect(dialog).toContainText('The state has moved');
		await expect(dialog.getByRole('alert').filter({ hasText: 'Something has changed' })).toBeVisible();
		await expect(dialog.getByTestId('moved')).toContainText('placed → empty');
		await expect(dialog.getByRole('radio', { name: 'tightened' })).toBeChecked();
		await expect(dialog.getByRole('button', { name: 'Correct…', exact: true })).toHaveAttribute('aria-disabled', 'true');
		await expect(undo).toBeHidden();
		await expect(variable(state, name)).toHaveAttribute('data-value', 'empty');
		await dialog.getByRole('button', { name: 'Cancel' }).click();
	});

	await ask(other, 'POST', 'restart/leave', {});
	await ask(other, 'PUT', 'mode', { mode: 'automatic' });
	await expect(state.getByTestId('mode')).toContainText('Automatic');
});
