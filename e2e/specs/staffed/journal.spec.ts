import { examine } from '../../station/barriers.ts';
import { acknowledge, done, offerWatch, startProduction, tightenings, typeCode } from '../../station/seen.ts';
import { EVA } from '../../station/station.ts';
import { WRIST, expect, test } from '../../station/test.ts';

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

/** Milliseconds within which a revoked watch shows nothing any more. */
const SOON = { timeout: 2000 };
const WATCH = 'Watch at the engine';

test('a bolt pair is tightened with a paired watch, and the journal names who did what @long', async ({
	browse,
	operate,
	station
}) => {
	const watches = await browse(EVA, '/wearables');
	const watch = await browse(null, '/operator', WRIST);
	await startProduction(operate);

	const code = await test.step('a device becomes a watch with a code, once somebody has confirmed it', async () => {
		const code = await offerWatch(watches, WATCH);
		await examine(watches, 'watches');
		await typeCode(watch, code);
		await expect(watch.getByText(`Confirm ${WATCH} on the station’s page`)).toBeVisible();
		await expect(watches.getByRole('heading', { name: `Is this ${WATCH}?` })).toBeVisible();
		await expect(watches.getByText('127.0.0.1').first()).toBeVisible();
		await expect(done(watch)).toHaveCount(0);
		await watches.getByRole('button', { name: 'Confirm' }).click();
		await expect(watches.locator(`[data-watch="${WATCH}"]`)).toContainText('Operator');
		return code;
	});

	await test.step('no other device becomes one with the same code', async () => {
		const other = await browse(null, '/operator', WRIST);
		await typeCode(other, code);
		await expect(other.getByRole('alert')).toContainText('This code does not work');
		await expect(other.getByRole('heading', { name: 'Pair this watch' })).toBeVisible();
		await examine(other, 'watch-pairing');
	});

	await test.step('its own task is done on it, and the work goes on', async () => {
		await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
		const before = await tightenings(operate);
		await acknowledge(watch);
		await operate.getByRole('button', { name: 'Pause', exact: true }).click();
		await expect(operate.getByTestId('mode')).toContainText('Paused');
		await operate.getByRole('button', { name: 'Continue' }).click();
		await expect(operate.getByTestId('mode')).toContainText('Automatic');
		await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBeGreaterThan(before);
	});

	await test.step('revoked, it says so and shows nothing', async () => {
		await watches.getByRole('button', { name: `Revoke ${WATCH}` }).click();
		await watches.getByRole('dialog').getByRole('button', { name: 'Revoke' }).click();
		await expect(watch.getByRole('alert')).toContainText('Revoked or expired', SOON);
		await expect(done(watch)).toHaveCount(0);
	});

	await test.step('the journal says who, when, what, on what and from where', async () => {
		await operate.goto(`${station.url}/journal`);
		for (const [who, what, on] of [
			['Eva', 'Took control', ''],
			['Eva', 'Started production', ''],
			['Eva', 'Offered to pair a watch', WATCH],
			['Eva', 'Confirmed a watch', WATCH],
			[`${WATCH} (watch)`, 'Said that a task is done', 'Place bolt pair'],
			['Eva', 'Changed the mode', 'paused'],
			['Eva', 'Changed the mode', 'automatic'],
			['Eva', 'Refused or revoked a watch', WATCH]
		] as const) {
			const record = operate
				.locator('tr[data-outcome="done"]')
				.filter({ has: operate.getByRole('cell', { name: who, exact: true }) })
				.filter({ has: operate.getByRole('rowheader', { name: what }) })
				.filter({ hasText: on })
				.first();
			await expect(record, `${who}: ${what} ${on}`).toContainText('127.0.0.1');
			const time = Date.parse((await record.locator('time').getAttribute('datetime')) ?? '');
			expect(Math.abs(Date.now() - time)).toBeLessThan(600_000);
		}
		await examine(operate, 'journal');
	});

	await test.step('and can be read only', async () => {
		// But for what one does on the page, which is told behind its question mark.
		const offered = operate.locator('main').locator('button:not([aria-keyshortcuts="?"]), input, textarea, [contenteditable]');
		expect(await offered.allInnerTexts()).toEqual((await offered.count()) === 0 ? [] : ['Older']);
		const answers = await operate.evaluate(() =>
			Promise.all(
				['POST', 'PUT', 'PATCH', 'DELETE'].map(async (method) => (await fetch('/api/v1/audit', { method })).status)
			)
		);
		expect(answers).toEqual([405, 405, 405, 405]);
	});
});
