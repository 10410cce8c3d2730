import type { Page } from '@playwright/test';
import { examine } from '../../station/barriers.ts';
import { takeControl } from '../../station/seen.ts';
import { ERIK, EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

/** What the server says of the day. */
async function read(page: Page): Promise<{ made: { count: number | null; planned: number | null } }> {
	return await page.evaluate(async () => (await fetch('/api/v1/figures')).json());
}

/** Stores an order that is due now; nobody lets it start. */
async function order(page: Page, id: string): Promise<void> {
	const status = await page.evaluate(async (id) => {
		const answer = await fetch('/api/v1/job-orders', {
			method: 'POST',
			headers: { 'Content-Type': 'application/json', 'Idempotency-Key': id },
			body: JSON.stringify({ id, work_master: 'truck_engine', description: `Engine ${id}`, due: Date.now() / 1000, start: false })
		});
		return answer.status;
	}, id);
	expect(status).toBe(201);
}

test.describe('of a station without shifts', () => {
	test.use({ shared: 'figures', byItself: false, devices: true, people: 'Eva' });

	test('the figures of the day are on Operate and on the wall, and what nobody knows is said to be unknown', async ({ browse }) => {
		const eva = await browse(EVA, '/');
		const strip = eva.getByRole('region', { name: 'Figures of the day' });
		await expect(strip.locator('dt')).toHaveText(['In work', 'Made today', 'Cycle time', 'Available today']);
		await expect(strip.locator('[data-figure="in-work"]')).toHaveText('No product');
		await expect(strip.locator('[data-figure="cycle"]')).toHaveText('After the first product');
		await expect(strip.locator('[data-figure="availability"]')).toHaveText('After 15 s of work');
		await expect(strip.locator('[data-figure="made"]')).toHaveText('0');

		await order(eva, '4711');
		await order(eva, '4712');
		await expect.poll(async () => (await read(eva)).made.planned).toBe(2);
		await expect(strip.locator('[data-figure="made"]')).toHaveText('0 of 2 due today', { timeout: 15_000 });
		await expect(strip.getByRole('img', { name: '0 of 2 orders are made, 2 were due by now' })).toBeVisible();

		await eva.goto('/wall');
		await expect(eva.locator('[data-figure="made"]')).toHaveText('0 of 2 due today');
		await expect(eva.getByText('2 behind. Mark: due by now.')).toBeVisible();
		await examine(eva, 'wall');
	});

	test('the wall fills the screen, and Pause and Hold are there when it does not', async ({ browse }) => {
		const eva = await browse(EVA, '/wall');
		const hold = eva.getByRole('button', { name: 'Hold', exact: true });
		await expect(hold).toBeInViewport({ ratio: 1 });
		await eva.getByRole('button', { name: 'Full screen' }).click();
		await expect(eva.getByRole('button', { name: 'Leave full screen' })).toBeVisible();
		await expect.poll(() => eva.getByRole('main').boundingBox()).toEqual({ x: 0, y: 0, ...eva.viewportSize() });
		await expect(eva.locator('[data-glance="mode"]')).toBeInViewport({ ratio: 1 });
		await eva.getByRole('button', { name: 'Leave full screen' }).click();
		await expect(hold).toBeInViewport({ ratio: 1 });
	});

	test('a wall that does not hear the station says so in its largest letters', async ({ browse, station }) => {
		const eva = await browse(EVA, '/wall');
		await expect(eva.locator('[data-glance="mode"]')).toBeVisible();
		station.server.signalTree('SIGSTOP');
		try {
			const stale = eva.getByTestId('wall-stale');
			await expect(stale).toBeInViewport({ ratio: 1, timeout: 5000 });
			await expect(stale).toContainText('Not live');
			expect(await stale.evaluate((element) => parseFloat(getComputedStyle(element).fontSize))).toBeGreaterThanOrEqual(60);
			await expect(eva.locator('[data-glance="alarms"]')).toContainText('when last heard');
		} finally {
			station.server.signalTree('SIGCONT');
		}
		await expect(eva.getByTestId('wall-stale')).toBeHidden();
	});
});

test.describe('of a station with shifts', () => {
	test.use({ shared: null, byItself: false, devices: true, people: 'everybody', copied: 'bolt_tightening' });

	/** 40 letters. */
	const TITLE = 'Everybody who works at this bolt station';

	test('those of the shift that is on are beside those of the day from when it is deployed', async ({ browse, drafting, complaints }) => {
		const page = await browse(ERIK, '/');
		const strip = page.getByRole('region', { name: 'Figures of the day' });
		await expect(strip.locator('dt')).toHaveText(['In work', 'Made today', 'Cycle time', 'Available today']);

		// Round the clock: it is on whenever this is tried.
		await drafting.change('Shifts', ['shifts.yaml', '', `all:\n  title: ${TITLE}\n  from: "06:00"\n  to: "06:00"\n`]);
		await page.goto(`/model?${new URLSearchParams({ entry: 'shifts.yaml#all' })}`);
		await expect(page.getByRole('treeitem', { name: 'Shifts' })).toBeVisible();
		await expect(page.getByRole('region', { name: 'Chosen part' })).toContainText('all');
		const [number, revision] = await Promise.all([drafting.checked(), drafting.save('Shifts')]);
		await page.goto('/');
		await takeControl(page);
		const deployed = page.evaluate(
			async ([id, number]) => {
				const headers = { 'Content-Type': 'application/json' };
				const body = JSON.stringify({ revision: id, number, reason: 'Shifts' });
				return (await fetch('/api/v1/model/deployments', { method: 'POST', headers, body })).status;
			},
			[revision, number] as const
		);
		expect(await deployed).toBe(204);

		const [made, available] = [strip.locator('dt').nth(1), strip.locator('dt').nth(3)];
		await expect(available).toHaveText(`Available · ${TITLE}`, { timeout: 60_000 });
		await expect(available).toHaveAttribute('title', new RegExp(`^${TITLE}, .*06:00 to .*06:00$`));
		await expect(made).toHaveText('Made this shift');
		await expect(strip.locator('[data-figure="made"]')).toHaveText('0');
		await expect(strip.locator('[data-figure="made-today"]')).toHaveText('0 today');
		// Nobody has let it produce: in a shift that counts, and the day has not begun.
		await expect(strip.locator('[data-figure="availability"]')).toHaveText('0.0 %', { timeout: 30_000 });
		await examine(page, 'operate in a shift');

		await page.goto('/wall');
		await expect(page.getByText('Made this shift · 0 today')).toBeVisible();
		await expect(page.getByText(`Available · ${TITLE}`)).toBeVisible();
		await expect(page.locator('[data-figure="availability"]')).toHaveText('0.0 %');
		await examine(page, 'wall in a shift');
		expect(complaints.filter((each) => !/WebSocket|Failed to load/.test(each))).toEqual([]);
	});
});
