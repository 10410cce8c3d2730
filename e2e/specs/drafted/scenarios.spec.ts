import { examine } from '../../station/barriers.ts';
import { INA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'drafted', byItself: false, people: 'everybody', copied: 'bolt_tightening' });

/** The server prepares the model first, then simulates, with what the machine has to spare. */
const SIMULATED = { timeout: 60_000 };

test('what was tried in simulation is kept as a test, which is run, fails where it must, and is looked at', async ({ browse }) => {
	const page = await browse(INA, '/what-if?simulation');
	const main = page.locator('main');
	const dialog = page.getByRole('dialog');
	const keep = async (title: string, condition: string): Promise<void> => {
		await main.getByRole('button', { name: 'Keep as a test…' }).click();
		await dialog.getByLabel('What it is called').fill(title);
		await dialog.getByLabel('Condition that is to hold at its end').fill(condition);
		await dialog.getByRole('button', { name: 'Keep', exact: true }).click();
	};

	await test.step('it is tried from the model’s beginning until a condition holds', async () => {
		await main.getByLabel('Begins with').selectOption({ label: 'the model’s beginning' }, SIMULATED);
		await main.getByRole('button', { name: 'Reset' }).click();
		await main.getByRole('textbox', { name: 'Condition' }).fill('all pair in bolt_pair: bolts[pair] != empty');
		await main.getByRole('button', { name: 'Run until' }).click();
		await expect(main.getByText('The condition holds')).toBeVisible(SIMULATED);
	});

	await test.step('and kept: what it expects is checked before', async () => {
		await keep('All pairs are placed', 'all pair in bolt_pair: bolts[pair] != emty');
		await expect(dialog.getByRole('alert')).toContainText('emty', SIMULATED);
		await examine(page, 'keep-a-test');
		await dialog.getByRole('button', { name: 'Cancel' }).click();
		await keep('All pairs are placed', 'all pair in bolt_pair: bolts[pair] != empty');
		await expect(main.getByText('Kept as a test: “All pairs are placed”.')).toBeVisible(SIMULATED);
		await keep('All pairs are tight', 'all pair in bolt_pair: bolts[pair] == tightened');
		await expect(main.getByText('Kept as a test: “All pairs are tight”.')).toBeVisible(SIMULATED);
	});

	await test.step('all are run; of the one that fails it is said why, and where that stands', async () => {
		await main.getByRole('link', { name: 'All tests' }).click();
		const listed = (name: string) => page.locator(`[data-scenario="${name}"]`);
		await expect(page.locator('[data-scenario]')).toHaveCount(5, SIMULATED);
		await page.getByRole('button', { name: 'Run all', exact: true }).click();
		await expect(listed('all_pairs_are_placed')).toHaveAttribute('data-passed', 'true', { timeout: 120_000 });
		await expect(listed('all_pairs_are_tight')).toContainText('did not come to hold within');
		await expect(listed('all_pairs_are_tight').getByRole('link', { name: /^tests\/scenarios\.yaml:\d+$/ })).toBeVisible();
		await expect(page.getByText('4 passed, 1 failed')).toBeVisible();
		await examine(page, 'tests');
	});

	await test.step('it is looked at in simulation, moment by moment', async () => {
		await page.getByRole('link', { name: 'Look at it: All pairs are tight' }).click();
		await expect(main.getByText('Test failed:')).toBeVisible(SIMULATED);
		await expect(main.locator('.lanes .bar.past')).not.toHaveCount(0);
		await main.getByRole('slider', { name: 'Moment' }).press('ArrowLeft');
		await expect(main.getByText(/What you do now is done here/)).toBeVisible();
	});

	await test.step('what was kept is taken back as any other change', async () => {
		await page.goto(`${new URL(page.url()).origin}/model?panel=tests`);
		for (const title of ['All pairs are tight', 'All pairs are placed']) await page.getByRole('button', { name: `Undo: Add the test “${title}”` }).click();
		await expect(page.locator('[data-scenario]')).toHaveCount(3, SIMULATED);
	});
});
