/** The page *Operations* beside a station at work. */
import { expect, test } from '../../station/test.ts';

test('over time work is told apart from waiting, and a bar chooses its operation', async ({ browse, complaints }) => {
	const page = await browse(null, '/operations?view=time');
	const time = page.getByTestId('operations-time');
	const bars = time.getByRole('button', { name: /at work, .* waiting$/ });
	await expect(time.locator('.run').first()).toBeVisible();
	await expect(time.locator('.wait').first()).toBeAttached();
	await expect(time.getByRole('list', { name: 'What is drawn how' })).toContainText('Waits');
	// One tab stop, from which the arrow keys lead on.
	await expect(time.locator('button[tabindex="0"]')).toHaveCount(1);
	await bars.first().focus();
	await page.keyboard.press('ArrowDown');
	await expect(bars.nth(1)).toBeFocused();
	await page.keyboard.press('Home');
	await expect(bars.first()).toBeFocused();
	const title = /^(.*): /.exec((await bars.first().getAttribute('aria-label'))!)![1]!;
	await page.keyboard.press('Enter');
	const heading = page.getByRole('complementary', { name: 'The chosen operation' }).getByRole('heading', { level: 2 });
	await expect(heading).toHaveText(title);
	await expect(heading).toBeFocused();
	await page.keyboard.press('Escape');
	await expect(bars.first()).toBeFocused();
	await expect(heading).toHaveCount(0);
	expect(complaints).toEqual([]);
});
