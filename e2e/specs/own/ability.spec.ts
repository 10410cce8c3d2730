import type { Locator, Page } from '@playwright/test';
import { examine, findings } from '../../station/barriers.ts';
import { acknowledge, picture, restsOnPerson, takeControl, variable } from '../../station/seen.ts';
import { ADA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

const address = (ability: string): string => `/model?${new URLSearchParams({ ability, panel: 'runs' })}`;
const moveTo = (pose: string): string => `robot.move_to_position(${pose})`;
const region = (page: Page, name: string): Locator => page.getByRole('region', { name, exact: true });
const phase = (page: Page): Locator => page.getByTestId('phase');
const press = (page: Page): Locator => region(page, 'Try it').getByRole('button', { name: 'Try it' });
const step = (page: Page, name: string): Locator => page.getByTestId('trial').locator(`[data-step="${name}"]`);

/** Tries the ability that is shown, and waits until it has finished. */
async function tried(page: Page): Promise<void> {
	await press(page).click();
	await expect(step(page, 'finished')).toHaveAttribute('data-mark', 'done', { timeout: 30_000 });
}

test.describe('a station that works', () => {
	test.use({ shared: 'trying' });

	test('an ability is seen as it is, tried alone, and refused where the supervisor does not allow it', async ({
		station,
		operate,
		state,
		watch
	}) => {
		await restsOnPerson(operate, watch);
		const pose = (await variable(state, 'robot.pose').getAttribute('data-value')) ?? '';

		await test.step('from its resource it is a step to an ability, and what it does stands there', async () => {
			await operate.getByTestId('mimic').locator('[role="button"][data-symbol="robot"]').press('Enter');
			await operate.getByRole('dialog', { name: 'Robot UR10' }).getByRole('link', { name: 'Move to home' }).click();
			await expect(operate.getByRole('heading', { name: 'move_to_position', level: 2 })).toBeVisible();
			const now = region(operate, 'In the station that runs');
			await expect(now.getByRole('combobox', { name: 'Which one' })).toHaveValue(moveTo('home'));
			// Folded it says how many hold; how it is left is how it is found again.
			await expect(now.getByTestId('may-start')).toContainText(/\d+ of \d+ hold, not|all \d+ hold/);
			await now.getByRole('button', { name: /^May start when/ }).click();
			await expect(now.getByRole('list', { name: 'May start when' }).locator('[title="robot.target_pose == robot.pose"]')).toBeVisible();
			await now.getByRole('button', { name: 'Try it' }).click();
			await expect(press(operate)).toHaveAttribute('aria-disabled', 'true');
			await expect(operate.getByTestId('hindrance')).not.toBeEmpty();
		});

		await test.step('it may be tried only by who has control, and while the station is paused', async () => {
			await takeControl(operate);
			await expect(operate.getByTestId('hindrance')).toContainText('Pause it first');
			await operate.getByTestId('strip').getByRole('button', { name: 'Pause' }).click();
			await expect(operate.getByTestId('mode')).toContainText('Paused');
		});

		await test.step('a guard that does not hold now says which part of it does not', async () => {
			await operate.goto(station.url + address(moveTo(pose === 'home' ? 'home' : pose)));
			await expect(phase(operate)).toHaveAttribute('data-phase', 'idle');
			const lacking = operate.getByRole('list', { name: 'May start when' }).locator('[data-holds="false"]');
			await expect(lacking.first()).toContainText('does not hold');
			await expect(operate.getByTestId('hindrance')).toContainText('waits for');
		});

		await test.step('tried, it runs once, is seen to, and the station stays paused', async () => {
			if (pose !== 'home') {
				await operate.goto(station.url + address(moveTo('home')));
				await tried(operate);
			}
			await operate.getByRole('combobox', { name: 'Which one' }).selectOption(moveTo('above_engine'));
			await expect(phase(operate)).toHaveAttribute('data-phase', 'enabled');
			await press(operate).focus();
			await operate.keyboard.press('Enter');
			await expect(phase(operate)).toHaveAttribute('data-phase', 'executing');
			await expect(operate.getByRole('button', { name: 'Stop the trial' })).toBeVisible();
			await picture(operate, 'ability-executing');
			await expect(step(operate, 'finished')).toHaveAttribute('data-mark', 'done', { timeout: 30_000 });
			for (const name of ['sent', 'accepted', 'started', 'executing'])
				await expect(step(operate, name)).toHaveAttribute('data-mark', 'done');
			const arrives = operate.getByTestId('trial').locator('[data-reacted$="robot_arrives"]');
			await expect(arrives).toHaveAttribute('data-came', 'came');
			await expect(operate.getByTestId('mode')).toContainText('Paused');
			await expect(phase(operate)).toHaveAttribute('data-phase', 'idle');
			await expect(operate.getByRole('button', { name: 'Stop the trial' })).toBeHidden();
		});

		await test.step('what the supervisor does not allow is refused with its reason', async () => {
			const pair = await acknowledge(watch);
			await operate.goto(station.url + address(moveTo(pair)));
			const supervised = region(operate, 'The supervisor adds');
			await operate.getByText('Automaton', { exact: true }).click();
			await expect(supervised).toHaveAttribute('data-allowed', 'false');
			await expect(supervised).toContainText('The nutrunner must turn before it meets placed bolts');
			await expect(operate.getByTestId('hindrance')).toContainText('The nutrunner must turn before it meets placed bolts');
			await expect(press(operate)).toHaveAttribute('aria-disabled', 'true');
			const problem = await operate.evaluate(async (ability) => {
				const headers = { 'Content-Type': 'application/json' };
				const answer = await fetch('/api/v1/test-runs', { method: 'POST', headers, body: JSON.stringify({ ability }) });
				return { status: answer.status, ...((await answer.json()) as { type: string; detail: string }) };
			}, moveTo(pair));
			expect(problem).toMatchObject({ status: 409, type: '/problems/not-startable' });
			expect(problem.detail).toContain('because of: The nutrunner must turn before it meets placed bolts');
		});

		await test.step('the table says the same, and nobody is kept from it', async () => {
			await operate.getByText('As a table').click();
			await expect(operate.locator('tr[data-part="supervised"]').first()).toBeVisible();
			await expect(operate.locator('tr[data-part="reaction"]').first()).toContainText('resources/robot.yaml');
			await examine(operate, 'ability');
		});

		await test.step('and the station works on', async () => {
			await operate.setViewportSize({ width: 1440, height: 900 });
			await operate.getByTestId('strip').getByRole('button', { name: 'Continue' }).click();
			await expect(operate.getByTestId('mode')).toContainText('Automatic');
		});
	});
});

test.describe('devices that are not known to be emulated', () => {
	test.use({ shared: null, byItself: false, people: 'everybody' });

	test('a warning is confirmed first, and Stop ends what was tried @long', async ({ station, operate: operators, browse }) => {
		station.emulate();
		await operators.goto(new URL(address(moveTo('above_engine')), operators.url()).href);
		await expect(region(operators, 'Try it')).toContainText('An engineer can try');
		await expect(press(operators)).toBeHidden();
		const operate = await browse(ADA, address(moveTo('above_engine')));
		await takeControl(operate);
		await expect(operate.getByTestId('hindrance')).toContainText('production');
		await operate.getByTestId('strip').getByRole('button', { name: 'Pause' }).click();
		await operate.getByRole('button', { name: 'Start production' }).click();
		await expect(operate.getByTestId('hindrance')).toBeEmpty({ timeout: 30_000 });
		await press(operate).click();
		const dialog = operate.getByRole('dialog');
		await expect(dialog).toContainText('Real devices move');
		const sure = dialog.getByRole('button', { name: 'Try it' });
		await expect(sure).toHaveAttribute('aria-disabled', 'true');
		await picture(operate, 'ability-real');
		expect(await findings(operate)).toEqual([]);
		await dialog.getByRole('checkbox').check();
		await dialog.getByLabel('Reason').fill('to see it move');
		await sure.click();
		await expect(dialog).toBeHidden();
		await expect(phase(operate)).toHaveAttribute('data-phase', 'executing');
		await picture(operate, 'ability-real-executing');
		await operate.getByRole('button', { name: 'Stop the trial' }).click();
		await expect(step(operate, 'ended')).toHaveAttribute('data-mark', 'done');
		await expect(operate.getByTestId('trial')).toContainText('to see it move');
		await expect(operate.getByTestId('trial')).toContainText('stopped it');
		await operate.setViewportSize({ width: 1440, height: 2200 });
		await picture(operate, 'ability-whole');
		await operate.setViewportSize({ width: 192, height: 1400 });
		await picture(operate, 'ability-narrow');
	});
});
