/** People who sign in with a provider, and what needs two of them. */
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import { CLIENT, Providing, SECRET } from '../../station/providing.ts';
import { signOut, takeControl, variable } from '../../station/seen.ts';
import { ADA, ADAM, ERIK, EVA, INA, ROOT, Station, freePort } from '../../station/station.ts';
import { test as base, expect } from '../../station/test.ts';
import type { Locator, Page } from '@playwright/test';

const OTTO = { preferred_username: 'Otto', groups: ['station-operators'] };
const NILS = { preferred_username: 'Nils', groups: ['sales'] };
const DUAL = ['    type: bolt_state\n', '    type: bolt_state\n    approval: dual\n'] as const;
const APPROVED = ['\nenumerations:', '\ndeployment_approval: dual\n\nenumerations:'] as const;

/** One station for all: to start it takes longer than the tests. Its bolts ask for two people, and so does each deployment. */
const test = base.extend<object, { provided: { station: Station } }>({
	provided: [
		async ({}, use, info) => {
			const folder = mkdtempSync(join(tmpdir(), 'dual-'));
			const model = join(folder, 'bolt_tightening');
			cpSync(join(ROOT, 'models/bolt_tightening'), model, { recursive: true });
			const file = join(model, 'station.yaml');
			const text = readFileSync(file, 'utf8');
			for (const [before] of [DUAL, APPROVED]) expect(text).toContain(before);
			writeFileSync(file, text.replace(...DUAL).replace(...APPROVED));
			const port = await freePort();
			const station = await Station.start({
				byItself: false,
				devices: true,
				people: [ADA, EVA, ADAM, ERIK, INA],
				model,
				logs: join(import.meta.dirname, `../../artefacts/logs/two-people-${info.workerIndex}`),
				environment: {
					SEQUENCE_PLANNER_OIDC_ISSUER: `http://127.0.0.1:${port}`,
					SEQUENCE_PLANNER_OIDC_CLIENT: CLIENT,
					SEQUENCE_PLANNER_OIDC_CLIENT_SECRET: SECRET,
					SEQUENCE_PLANNER_OIDC_TITLE: 'Works ID',
					SEQUENCE_PLANNER_OIDC_ROLE: 'operator=station-operators'
				}
			});
			const provider = await Providing.start(port, station.url, { otto: OTTO, nils: NILS });
			await use({ station });
			await provider.stop();
			await station.stop();
			rmSync(folder, { recursive: true });
		},
		{ scope: 'worker', timeout: 90_000 }
	],
	station: async ({ provided }, use) => {
		await use(provided.station);
	}
});

/** At the provider: says who one is. */
async function beAtProvider(page: Page, login: string): Promise<void> {
	await page.getByRole('button', { name: 'Sign in with Works ID' }).click();
	await page.locator('input[name="login"]').fill(login);
	await page.locator('input[name="password"]').fill('any');
	await page.locator('button[type="submit"]').click();
}

test('who signs in with the provider comes to the page that was asked for, and signs out of both @long', async ({
	browse,
	station
}) => {
	const otto = await browse(null, '/journal');
	await expect(otto).toHaveURL('/sign-in?to=%2Fjournal');
	await examine(otto, 'sign-in-provider');
	await beAtProvider(otto, 'otto');
	await expect(otto).toHaveURL('/journal');
	await expect(otto.getByTestId('who')).toContainText('Otto');
	await otto.goto('/account');
	await expect(otto.getByText('You sign in with Works ID, and have no password here.')).toBeVisible();
	await expect(otto.getByLabel('Current password')).toHaveCount(0);

	await otto.goto('/journal');
	await signOut(otto);
	await expect(otto.getByRole('heading', { name: 'Sign in' })).toBeVisible();
	await otto.getByRole('link', { name: 'Sign out of Works ID as well' }).click();
	await otto.locator('button[name="logout"]').click();
	await expect(otto).toHaveURL(`${station.url}/sign-in`);
	await expect(otto.getByRole('button', { name: 'Sign in with Works ID' })).toBeVisible();

	const ada = await browse(ADA, '/users');
	await examine(ada, 'people-provided');
	const row = ada.locator('[data-person="Otto"]');
	await expect(row).toContainText('signs in with http');
	await expect(row.getByRole('button', { name: 'New password for Otto' })).toHaveCount(0);
});

test('who has no role is told so where they sign in, and an answer that nobody waits for is not taken', async ({
	browse
}) => {
	const nils = await browse(null, '/sign-in');
	await beAtProvider(nils, 'nils');
	await expect(nils.getByRole('alert').first()).toContainText('in none of the groups that may use this station');
	await expect(nils).toHaveURL('/sign-in/provider');
	await examine(nils, 'provider-refused');
	await nils.goto('/sign-in/provider?code=stolen&state=forged');
	await expect(nils.getByRole('alert').first()).toContainText('was not begun in this browser');
	expect(await nils.evaluate(() => location.search)).toBe('');
	await nils.goto('/sign-in/provider');
	await expect(nils).toHaveURL('/sign-in');
});

test('what asks for two people is asked for by one and done by another', async ({ browse }) => {
	const [eva, adam] = [await browse(EVA, '/state?kind=estimated'), await browse(ADAM, '/')];
	await takeControl(eva);
	const bolts = 'bolts[bolt_pair_1]';
	await eva.locator(`[data-row="${bolts}"]`).getByRole('button', { name: /^Correct…/ }).click();
	const dialog = eva.getByRole('dialog');
	await dialog.getByRole('radio', { name: 'placed' }).check();
	await expect(dialog.getByTestId('follows')).toBeVisible({ timeout: 30_000 });
	await dialog.getByLabel('Reason').fill('seen with my own eyes');
	await expect(dialog.getByText('A second person has to approve this.')).toBeVisible();
	await dialog.getByRole('button', { name: 'Ask a second person…' }).click();
	await dialog.getByRole('button', { name: 'Yes, ask' }).click();
	await expect(eva.locator('[data-approval="waiting"]')).toContainText('You have asked a second person');

	const waits = adam.locator('[data-approval="waiting"]');
	await expect(waits).toContainText('Eva asks a second person');
	await adam.getByRole('button', { name: 'Look and decide…' }).click();
	await expect(adam.getByTestId('approve').getByTestId('follows')).toBeVisible({ timeout: 30_000 });
	await examine(adam, 'approve');
	await adam.setViewportSize({ width: 1440, height: 900 });
	await adam.getByRole('button', { name: 'Approve', exact: true }).click();
	await expect(eva.locator('[data-approval="approved"]')).toContainText('approved and done');
	await expect(variable(eva, bolts)).toHaveAttribute('data-value', 'placed');
});

test('what is deployed was approved by somebody else than who saved it, and who wants changes is heard', async ({
	drafting,
	browse
}) => {
	test.slow();
	const [erik, ina, ada] = [await browse(ERIK, '/review'), await browse(INA, '/review'), await browse(ADA, '/')];
	const WAITS = /Revision 2, “Bolt cell”, by Erik waits for a second person’s approval\./;
	const mark = (page: Page): Locator => page.getByRole('link', { name: 'Review changes' }).locator('.badge');
	const waits = (page: Page): Locator => page.getByTestId('waits');
	/** Who else may approve it is told that it waits for that, on the page, on Operate and in the rail, without a reload. */
	const told = async (is: boolean): Promise<void> => {
		for (const page of [ina, ada]) {
			if (is) await expect(waits(page)).toHaveText(WAITS, { timeout: 20_000 });
			else await expect(waits(page)).toHaveCount(0, { timeout: 20_000 });
			await expect(mark(page)).toHaveText(is ? '!' : '1');
		}
		await expect(waits(erik)).toHaveCount(0);
	};
	await drafting.change('Another title', ['station.yaml', 'title: {en: Bolt tightening station,', 'title: {en: Bolt cell,']);
	const need = (page: Page, name: string): Locator => page.locator(`[data-need="${name}"]`);
	await expect(need(erik, 'approved')).toContainText('It can be approved once it is saved.');
	await erik.getByTestId('draft').getByRole('button', { name: 'Save revision…' }).click();
	const saving = erik.getByRole('dialog', { name: 'Save the draft as a revision' });
	await saving.getByLabel('Name').fill('Bolt cell');
	await saving.getByRole('button', { name: 'Save', exact: true }).click();
	await expect(need(erik, 'approved')).toContainText('You have saved it: somebody else has to approve it on this page.');
	await expect(need(erik, 'approved').getByRole('button')).toHaveCount(0);
	await told(true);
	await expect(mark(erik)).toHaveText('1');
	await expect(mark(ada)).toHaveAttribute('title', WAITS);
	await expect(waits(ada).getByRole('link', { name: 'Look at the changes' })).toHaveAttribute('href', '/review');
	await examine(ina, 'review-waits');
	await ina.setViewportSize({ width: 1440, height: 900 });

	await waits(ina).getByRole('button', { name: 'Approve, or ask for changes' }).click();
	const field = ina.getByLabel('Say something to the other engineers');
	await expect(field).toBeFocused();
	await expect(ina.getByRole('button', { name: 'Ask for changes', exact: true })).toHaveAttribute('aria-disabled', 'true');
	await ina.keyboard.type('Why is it no station any more?');
	await ina.getByRole('button', { name: 'Ask for changes', exact: true }).click();
	await expect(ina.getByText('Asked for changes in “Bolt cell”')).toBeVisible();
	await expect(field).toHaveValue('');
	await expect(need(erik, 'approved')).toContainText('Ina asked for changes.');
	await expect(need(erik, 'approved')).toHaveAttribute('data-met', 'false');
	await told(false);
	await erik.getByRole('tab', { name: /^Talk/ }).click();
	await expect(erik.getByText('Why is it no station any more?')).toBeVisible();
	await expect(erik.getByRole('button', { name: 'Approve', exact: true })).toHaveCount(0);
	await examine(ina, 'review-talk');
	await ina.setViewportSize({ width: 1440, height: 900 });

	await ina.getByRole('button', { name: 'Approve', exact: true }).click();
	await expect(ina.getByText('Approves “Bolt cell”')).toBeVisible();
	await expect(need(erik, 'approved')).toHaveAttribute('data-met', 'true');
	await expect(need(erik, 'approved')).toContainText('Approved by Ina.');
	await expect(erik.locator('[data-revision="Bolt cell"]')).toContainText('Approved by Ina.');
	await ina.getByRole('button', { name: 'Withdraw what I said of it' }).click();
	await expect(need(erik, 'approved')).toHaveAttribute('data-met', 'false');
	await told(true);
	await ina.getByRole('button', { name: 'Approve', exact: true }).click();
	await expect(need(erik, 'approved')).toHaveAttribute('data-met', 'true');
	await told(false);

	await need(erik, 'control').getByRole('button', { name: 'Take control' }).click();
	await erik.getByRole('dialog').getByRole('button', { name: 'Take over' }).click();
	await expect(need(erik, 'control')).toHaveCount(0);
	await erik.getByRole('button', { name: 'Deploy…' }).click();
	const dialog = erik.getByRole('dialog', { name: 'Deploy “Bolt cell”' });
	await dialog.getByLabel('I want “Bolt cell” to take the place of what runs.').check({ timeout: 30_000 });
	await dialog.getByLabel('Reason').fill('It is called so on the plan of the hall');
	await dialog.getByRole('button', { name: 'Deploy' }).click();
	await expect(erik.getByTestId('deployment')).toHaveAttribute('data-phase', 'runs', { timeout: 60_000 });
	await expect(erik.locator('[data-revision="Bolt cell"]')).toHaveAttribute('data-running', 'true');

	// Who looks for that later finds it in the journal.
	await ada.goto('/journal');
	const record = (act: string): Locator => ada.getByRole('row').filter({ has: ada.getByRole('rowheader', { name: act, exact: true }) });
	await expect(record('Deployed a revision')).toContainText('revision Bolt cell, approved by Ina');
	await expect(record('Approved a revision')).toHaveCount(2);
	for (const act of ['Approved a revision', 'Withdrew what they had said of a revision', 'Asked for changes in a revision']) {
		await expect(record(act).first()).toContainText('Ina');
		await expect(record(act).first()).toContainText('revision Bolt cell, saved by Erik');
	}
	await expect(record('Asked for changes in a revision')).toContainText('Why is it no station any more?');
});
