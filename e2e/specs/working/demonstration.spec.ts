import { findings } from '../../station/barriers.ts';
import { restsOnPerson, signOut, takeControl } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('a demonstration says that it is one, wherever one acts, and asks before it begins again', async ({
	operate,
	watch,
	station
}) => {
	await restsOnPerson(operate, watch);
	await expect(operate.getByTestId('demonstration')).toContainText('The devices are emulated; nothing real moves.');
	await expect(operate.getByTestId('who')).toContainText('Demonstration engineer');
	await takeControl(operate);
	await operate.goto(`${station.url}/journal`);
	const taken = operate.locator('tr[data-record]').filter({ hasText: 'Took control' }).first();
	await expect(taken).toContainText('Demonstration');
	await expect(operate.getByTestId('demonstration')).toBeVisible();

	await signOut(operate);
	await operate.getByRole('button', { name: 'Open the demonstration' }).click();
	await expect(operate.getByTestId('demonstration')).toBeVisible();
});

test('whoever is new is shown around by the keyboard alone, once, and never over Pause and Hold', async ({
	operate,
	station
}) => {
	const [offer, round] = [operate.getByTestId('round-offer'), operate.getByTestId('round')];
	await offer.getByRole('button', { name: 'Show me around' }).press('Enter');
	const titles = ['The station', 'The plan', 'Your task', 'Pause and Hold', 'When it stops'];
	for (const [n, title] of titles.entries()) {
		await expect(round.getByRole('heading', { name: title })).toBeFocused();
		await expect(round).toContainText(`Step ${String(n + 1)} of 5`);
		for (const name of ['Pause', 'Hold']) {
			const inReach = await operate.getByRole('button', { name, exact: true }).evaluate((button) => {
				const { left, top, width, height } = button.getBoundingClientRect();
				return button.contains(document.elementFromPoint(left + width / 2, top + height / 2));
			});
			expect(inReach, `${name} beside “${title}”`).toBe(true);
		}
		if (n === 0) {
			expect(await findings(operate)).toEqual([]);
			for (const button of await round.getByRole('button').all())
				expect((await button.boundingBox())?.height).toBeGreaterThanOrEqual(24);
		}
		// Past Skip, and Back where there is one.
		for (let presses = 0; presses < (n === 0 ? 2 : 3); presses++) await operate.keyboard.press('Tab');
		await operate.keyboard.press('Enter');
	}
	await expect(round).toHaveCount(0);
	await operate.reload();
	await expect(operate.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	await expect(offer).toHaveCount(0);

	// Whoever wants it again finds it under ?.
	await operate.keyboard.press('?');
	await operate.getByRole('link', { name: 'Show me around' }).press('Enter');
	await expect(round.getByRole('heading', { name: 'The station' })).toBeFocused();
	await operate.keyboard.press('Escape');
	await expect(round).toHaveCount(0);
	await expect(operate).toHaveURL(`${station.url}/`);
});
