/** What a person reads on the operator's page, and the pictures that are kept of it. */
import { expect, type Locator, type Page, test } from '@playwright/test';
import { join } from 'node:path';

export const PAIRS = ['bolt_pair_1', 'bolt_pair_2', 'bolt_pair_3'] as const;

/** A variable on State; its attribute `data-value` holds the value in the model's words. */
export function variable(page: Page, name: string): Locator {
	return page.locator(`[data-variable="${name}"]`);
}

/** How often the operation has been completed. */
export async function completed(page: Page, operation: string): Promise<number> {
	return Number(await page.locator(`[data-operation="${operation}"]`).getAttribute('data-completed'));
}

/** How many bolt pairs have been tightened since the start, over all engines. */
export async function tightenings(page: Page): Promise<number> {
	const each = await Promise.all(PAIRS.map((pair) => completed(page, `tighten_bolt_pair(${pair})`)));
	return each.reduce((sum, n) => sum + n, 0);
}

/** The button that says that a task is done. */
export function done(page: Page): Locator {
	return page.locator('button[data-task]');
}

/** Waits until all that is left to do is a person's: a task waits, and nothing else runs. */
export async function restsOnPerson(operate: Page, watch: Page): Promise<void> {
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	await expect(operate.locator('[data-status="running"]')).toHaveCount(1, { timeout: 60_000 });
	await expect(operate.locator('[data-status="running"]')).toHaveAttribute('data-step', /place_bolt_pair/);
}

/** Says on the watch that the task is done; returns the bolt pair that it was about. */
export async function acknowledge(watch: Page): Promise<string> {
	const words = (await done(watch).getAttribute('aria-label')) ?? '';
	const task = await done(watch).getAttribute('data-task');
	await done(watch).tap();
	await expect(watch.locator(`button[data-task="${task}"]`)).toHaveCount(0);
	const pair = /bolt pair \d/.exec(words)?.[0].replaceAll(' ', '_');
	if (pair === undefined) throw new Error(`no bolt pair is named in ${words}`);
	return pair;
}

/** Takes control on this page, from whoever has it. */
export async function takeControl(page: Page): Promise<void> {
	const control = page.getByTestId('control');
	await expect(page.getByTestId('mode')).toBeVisible();
	// On a small screen it is behind the mark of who is signed in.
	if (!(await control.isVisible())) await page.getByTestId('who').click();
	const held = (await control.getAttribute('data-holder')) !== 'nobody';
	await page.getByRole('button', { name: 'Take control', exact: true }).click();
	if (held) await page.getByRole('dialog').getByRole('button', { name: 'Take over' }).click();
	await expect(control).toHaveAttribute('data-holder', 'you');
}

/** Takes control on this page, and starts production unless that was done. */
export async function startProduction(page: Page): Promise<void> {
	await takeControl(page);
	const start = page.getByRole('button', { name: 'Start production' });
	if (await start.isVisible()) await start.click();
	await expect(page.getByTestId('mode')).toHaveAttribute('data-production', 'started');
}

/** Signs in on the page that asks for it. */
export async function signIn(page: Page, name: string, password: string): Promise<void> {
	await page.getByLabel('Name').fill(name);
	await page.getByLabel('Password', { exact: true }).fill(password);
	await page.getByRole('button', { name: 'Sign in' }).click();
}

/** Signs out as a person does. */
export async function signOut(page: Page): Promise<void> {
	await page.getByTestId('who').click();
	await page.getByRole('button', { name: 'Sign out' }).click();
}

/** On the page Watches: offers to pair a watch; the code. */
export async function offerWatch(watches: Page, name: string): Promise<string> {
	await watches.getByLabel('Name of the wearable').fill(name);
	await watches.getByRole('button', { name: 'Get a code' }).click();
	return (await watches.getByTestId('code').innerText()).replaceAll(/\D/g, '');
}

/** On a device: types a code in, to become a watch. */
export async function typeCode(device: Page, code: string): Promise<void> {
	await device.getByLabel('Code of 8 digits').fill(code);
	await device.getByRole('button', { name: 'Pair' }).click();
}

/** Notes every value that the page shows for a variable from now on; the result says which it were. */
export async function values(page: Page, name: string): Promise<() => Promise<string[]>> {
	const notes = await variable(page, name).evaluateHandle((element) => {
		const said: string[] = [];
		const note = (): void => void said.push(element.getAttribute('data-value') ?? '');
		new MutationObserver(note).observe(element, { attributeFilter: ['data-value'] });
		return said;
	});
	return () => notes.jsonValue();
}

/** Keeps a picture among the artefacts, named after the theme. */
export async function picture(page: Page, name: string, theme = test.info().project.name): Promise<void> {
	const path = join(import.meta.dirname, '../artefacts', `${name}-${theme}.png`);
	await page.screenshot({ path });
}
