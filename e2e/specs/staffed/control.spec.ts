import { examine } from '../../station/barriers.ts';
import { signOut, takeControl } from '../../station/seen.ts';
import { ADAM, EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';
import type { Page } from '@playwright/test';

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

/** Milliseconds within which everybody sees who has control. */
const SOON = { timeout: 2000 };

test('one person has control: it is taken, taken over and given up in the sight of all @long', async ({ browse }) => {
	const [eva, adam] = [await browse(EVA, '/'), await browse(ADAM, '/')];
	const button = (page: Page, name: string) => page.getByRole('button', { name });
	const mode = (page: Page) => page.getByTestId('mode');
	const control = (page: Page) => page.getByTestId('control');

	await test.step('nothing is started without it', async () => {
		for (const page of [eva, adam]) {
			await expect(button(page, 'Start production')).toHaveAttribute('aria-disabled', 'true', { timeout: 30_000 });
			await expect(page.getByText('Take control first')).toBeVisible();
		}
	});

	await test.step('who takes it starts production, and others see who that is', async () => {
		await takeControl(eva);
		await expect(control(adam)).toHaveAttribute('data-holder', 'another', SOON);
		await expect(control(adam)).toContainText('Eva');
		await button(eva, 'Start production').click();
		for (const page of [eva, adam]) await expect(mode(page)).toHaveAttribute('data-production', 'started');
	});

	await test.step('anybody pauses; only who has it goes on', async () => {
		await button(adam, 'Pause').click();
		for (const page of [eva, adam]) await expect(mode(page)).toContainText('Paused');
		await expect(button(adam, 'Continue')).toHaveAttribute('aria-disabled', 'true');
		await button(eva, 'Continue').click();
		for (const page of [eva, adam]) await expect(mode(page)).toContainText('Automatic');
	});

	await test.step('it is taken over by name and with a reason', async () => {
		await button(adam, 'Take control').click();
		const dialog = adam.getByRole('dialog', { name: 'Take over control from Eva?' });
		await dialog.getByLabel('Reason').fill('Change of shift');
		await examine(adam, 'take-over');
		await button(adam, 'Pause').click();
		await expect(mode(adam)).toContainText('Paused');
		await dialog.getByRole('button', { name: 'Take over' }).click();
		await expect(control(eva)).toContainText('taken over from Eva', SOON);
		await expect(control(eva)).toContainText('Adam');
		await expect(control(adam)).toHaveAttribute('data-holder', 'you');
	});

	await test.step('who has lost it cannot go on, whatever is sent, but can pause', async () => {
		await expect(button(eva, 'Continue')).toHaveAttribute('aria-disabled', 'true');
		const refusal = await eva.evaluate(async () => {
			const headers = { 'Content-Type': 'application/json' };
			const body = JSON.stringify({ mode: 'automatic' });
			const answer = await fetch('/api/v1/mode', { method: 'PUT', headers, body });
			return [answer.status, ((await answer.json()) as { detail: string }).detail] as const;
		});
		expect(refusal).toEqual([409, expect.stringContaining('Adam is in control')]);
		await button(adam, 'Continue').click();
		await expect(mode(eva)).toContainText('Automatic');
		await button(eva, 'Pause').click();
		await expect(mode(adam)).toContainText('Paused');
	});

	await test.step('signing out gives it up', async () => {
		await signOut(adam);
		await expect(control(eva)).toHaveAttribute('data-holder', 'nobody', SOON);
		await takeControl(eva);
		await button(eva, 'Continue').click();
		await expect(mode(eva)).toContainText('Automatic');
	});

	await test.step('the journal says who took it over, and why', async () => {
		await eva.goto('/journal');
		const taken = eva.locator('tr[data-record]').filter({ hasText: 'Change of shift' });
		await expect(taken).toContainText('Adam');
		await expect(taken).toContainText('Took control');
		await expect(taken).toContainText('done');
	});
});
