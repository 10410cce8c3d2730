/** What the page says of a station at once when a device is gone: who can still do what, and what nobody can. */
import { examine, findings, outsideCircle } from '../../station/barriers.ts';
import { picture, takeControl } from '../../station/seen.ts';
import { expect, test, WRIST } from '../../station/test.ts';
import type { Page } from '@playwright/test';

test.use({ shared: null, copied: 'truck_engine_station' });

const ROBOT = 'Robot UR10';
const OPERATOR = 'Operator';

const group = (page: Page, name: 'nobody' | 'others') => page.getByTestId('who-can').locator(`[data-group="${name}"]`);

/** One engine is ordered, and worked by order. */
async function order(page: Page, url: string): Promise<void> {
	const headers = { 'Idempotency-Key': 'one' };
	await expect(async () => {
		const byOrder = await page.request.put(`${url}/api/v1/settings/job-mode`, { data: { on: true, reason: 'a test' } });
		expect(byOrder.ok(), await byOrder.text()).toBe(true);
	}).toPass(); // a controller on a busy machine can be late
	const data = { id: '4711', work_master: 'engine', start: true };
	const stored = await page.request.post(`${url}/api/v1/job-orders`, { data, headers });
	expect(stored.ok(), await stored.text()).toBe(true);
}

test('without the robot it is said at once who can still do what, and the bolts are tightened by hand @theme @long', async ({
	operate,
	state,
	station,
	browse
}) => {
	test.setTimeout(480_000);
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'started', { timeout: 120_000 });
	await takeControl(operate);
	await order(operate, station.url);
	const tightened = state.locator('[data-variable^="bolts["][data-value="tightened"]');
	await expect(state.locator('[data-variable^="bolts["][data-value="placed"]')).not.toHaveCount(0, { timeout: 300_000 });
	await station.fault('robot slow 6'); // so that there are bolts left however slow this machine is
	await expect(state.locator('[data-variable="end_effector.tool"][data-value="ATLASTOOL"]')).toHaveCount(1, { timeout: 120_000 });
	await expect(tightened).not.toHaveCount(6);
	await expect(operate.getByTestId('who-can')).toHaveCount(0);
	await station.fault('robot offline');
	const panel = operate.getByRole('region', { name: 'Who can do what' });
	// Why it is so is said once, by the alarm above it; the operations stay in sight below it.
	await expect(operate.getByTestId('restart-notice').getByRole('heading', { level: 2 })).toContainText(ROBOT, { timeout: 30_000 });
	await expect(panel).toContainText('cannot be done now');
	const said = operate.getByTestId('who-can');
	await expect(said).toBeHidden();
	await panel.getByRole('heading').click();
	await expect(said).toBeVisible();
	await expect(said.locator('[data-absent="robot"]')).toHaveCount(0);
	await expect(operate.getByTestId('mode')).not.toHaveClass(/\bwell\b/);
	await expect(group(operate, 'nobody')).toContainText(`needs ${ROBOT}`);
	await expect(group(operate, 'nobody').locator('[data-who-can="tighten_oil_filter"]')).toBeVisible();
	await examine(operate, 'who-can');
	await operate.setViewportSize({ width: 1440, height: 900 });

	const restart = await browse(null, '/restart');
	await expect(restart.getByTestId('who-can')).toContainText(`${ROBOT} is not heard.`);
	await picture(restart, 'who-can-restart');
	const watch = await browse(null, '/operator', WRIST);
	await expect(watch.getByText(`No contact: ${ROBOT}`)).toBeVisible();
	expect(await outsideCircle(watch)).toEqual([]);
	expect(await findings(watch)).toEqual([]);

	// What can still be done is done, as it was said.
	await expect(group(operate, 'others')).toContainText(`by ${OPERATOR}`, { timeout: 60_000 });
	await expect(group(operate, 'others')).toContainText('as soon as operator is standing in for the robot: yes');
	await station.byHand('operator.takes_over := true');
	await expect(tightened).toHaveCount(6, { timeout: 120_000 });
	await expect(group(operate, 'nobody').locator('[data-who-can="take_filter_tool"]')).toBeVisible();
	await expect(group(operate, 'others').locator('[data-who-can^="tighten_bolt_pair"]')).toHaveCount(0);
});
