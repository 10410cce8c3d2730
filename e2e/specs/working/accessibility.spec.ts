import { findings, smallTargets } from '../../station/barriers.ts';
import { done, restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('axe-core finds nothing on either page @theme', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	expect(await findings(operate)).toEqual([]);
	expect(await findings(watch)).toEqual([]);

	await operate.getByRole('button', { name: 'as table' }).click();
	await expect(operate.getByRole('table', { name: 'Steps of the plan' })).toBeVisible();
	expect(await findings(operate)).toEqual([]);
});

test('everything that can be pressed is large enough for a glove', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	for (const width of [1440, 320]) {
		await operate.setViewportSize({ width, height: 900 });
		expect(await smallTargets(operate)).toEqual([]);
	}
	expect(await smallTargets(watch)).toEqual([]);
});

test('a task is acknowledged with the keyboard alone, on either page', async ({ operate, watch }) => {
	for (const page of [operate, watch]) {
		await expect(done(page).first()).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
		const task = await done(page).first().getAttribute('data-task');
		const button = page.locator(`button[data-task="${task}"]`);

		// The rail has a way to every page: whoever wants none of them skips it.
		if (page === operate) {
			await page.keyboard.press('Tab');
			await expect(page.getByRole('link', { name: 'Skip to the page' })).toBeFocused();
			await page.keyboard.press('Enter');
		}
		for (let presses = 0; presses < 10; presses++) {
			await page.keyboard.press('Tab');
			if (await button.evaluate((element) => element === document.activeElement)) break;
		}
		await expect(button).toBeFocused();
		await expect(button).toHaveCSS('outline-style', 'solid');
		await page.keyboard.press('Enter');
		await expect(button).toHaveCount(0);
	}
});

test('the same plan can be read as lanes and as a table', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const blocks = operate.locator('[data-step]');
	const read = await blocks.evaluateAll((all) =>
		all.map((block) => [block.getAttribute('title') ?? '', block.getAttribute('data-status') ?? ''] as const)
	);
	expect(read.length).toBeGreaterThan(0);
	await operate.getByRole('button', { name: 'as table' }).press('Enter');
	const table = operate.getByRole('table', { name: 'Steps of the plan' });
	for (const [title, status] of read)
		await expect(table.locator('tbody tr').filter({ hasText: title }).filter({ hasText: status })).not.toHaveCount(0);
});
