import type { Page } from '@playwright/test';
import { createServer } from 'node:http';
import { examine, overflow } from '../../station/barriers.ts';
import { picture, takeControl } from '../../station/seen.ts';
import { ADA, EVA, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

/** Where another system listens for events. */
const PORT = 21_000 + (process.pid % 4000);

test.use({
	shared: 'orders',
	byItself: false,
	devices: true,
	people: 'everybody',
	environment: { SEQUENCE_PLANNER_WEBHOOK_HOST: `127.0.0.1:${PORT}`, SEQUENCE_PLANNER_WEBHOOK_LOOPBACK: 'true' }
});

/** Somebody does what people are asked to do until that is over. */
async function doTasks(page: Page, until: () => Promise<boolean>): Promise<void> {
	while (!(await until()))
		await page.evaluate(async () => {
			const { tasks } = (await (await fetch('/api/v1/tasks')).json()) as { tasks: Record<string, { revision: number }> };
			for (const [id, { revision }] of Object.entries(tasks))
				await fetch(`/api/v1/tasks/${encodeURIComponent(id)}/acknowledgement`, {
					method: 'POST',
					headers: { 'Content-Type': 'application/json' },
					body: JSON.stringify({ revision })
				});
			await new Promise((resolve) => setTimeout(resolve, 200));
		});
}

test('an order is stored, waits and says why, is worked, interrupted and resumed, and what was made is told', async ({ browse, complaints }) => {
	test.slow(); // three orders, of which each takes its time
	const eva = await browse(EVA, '/orders');
	// Nobody has given them a number: of the one that was drawn the end stands beside the description.
	const row = (title: string, page = eva) =>
		page.locator('[data-order]').filter({ has: page.getByRole('button', { name: new RegExp(`^${title} · [0-9a-f]{4}$`) }) });
	const dialog = eva.getByRole('dialog');
	const form = eva.getByRole('dialog', { name: 'New order' });
	const newOrder = (): Promise<void> => eva.getByRole('button', { name: 'New order' }).click();
	const store = async (description: string, priority: string): Promise<void> => {
		if (!(await form.isVisible())) await newOrder();
		await form.getByLabel('Description').fill(description);
		await form.getByLabel('Priority').fill(priority);
		await form.getByRole('button', { name: 'Add order' }).click();
		await expect(row(description)).toBeVisible();
		await expect(form).toHaveCount(0);
	};

	await test.step('what cannot be is not sent, and what was typed stays', async () => {
		await newOrder();
		await expect(form.getByLabel('What is made')).toHaveValue('truck_engine');
		await form.getByLabel('Description').fill('Engine 4711');
		await form.getByLabel('Priority').fill('-3');
		await expect(form.getByRole('button', { name: 'Add order' })).toHaveAttribute('aria-disabled', 'true');
		await form.getByLabel('Priority').press('Enter');
		await expect(form.getByLabel('Description')).toHaveValue('Engine 4711');
		await expect(eva.locator('[data-order]')).toHaveCount(0);
	});

	await test.step('an order that has a number is called by it, and has its description below', async () => {
		await form.getByRole('button', { name: 'Close' }).click();
		await eva.evaluate(async () => {
			const body = JSON.stringify({ id: 'D13-4719', work_master: 'truck_engine', description: 'Engine D13K 540', start: false });
			await fetch('/api/v1/job-orders', { method: 'POST', headers: { 'Content-Type': 'application/json', 'Idempotency-Key': 'D13-4719' }, body });
		});
		const numbered = eva.locator('[data-order="D13-4719"]');
		await expect(numbered.getByRole('button', { name: 'D13-4719', exact: true })).toBeVisible();
		await expect(numbered).toContainText('Engine D13K 540');
		await numbered.getByRole('button', { name: 'More for D13-4719' }).click();
		await numbered.getByRole('button', { name: 'Withdraw' }).click();
		await dialog.getByRole('button', { name: 'Withdraw' }).click();
		await expect(numbered).toHaveCount(0);
	});

	await test.step('an order waits for people, and says so; the more urgent one is to begin first', async () => {
		await store('Engine 4711', '0');
		await expect(row('Engine 4711')).toContainText('the station works freely');
		// The card has the first of it; the rest is read on request.
		await expect(row('Engine 4711').getByTitle('production is not started')).toBeVisible();
		await store('Engine 4712', '5');
		await expect(eva.locator('[data-order]').first()).toContainText('Engine 4712');
		await eva.getByRole('button', { name: 'By order' }).click();
		await dialog.getByLabel('Reason').fill('The MES orders from now on');
		await expect(dialog).toContainText('Take control first');
		await dialog.getByRole('button', { name: 'Cancel' }).click();
		await expect(eva.getByRole('button', { name: 'Freely' }), 'nothing was changed').toHaveAttribute('aria-pressed', 'true');
		await takeControl(eva);
		await eva.getByRole('button', { name: 'By order' }).click();
		await dialog.getByLabel('Reason').fill('The MES orders from now on');
		await dialog.getByRole('button', { name: 'Work by order' }).click();
		await expect(eva.getByRole('button', { name: 'By order' })).toHaveAttribute('aria-pressed', 'true');
		await examine(eva, 'orders-waiting');
	});

	await test.step('the first is worked; interrupted it begins nothing, resumed it goes on', async () => {
		await eva.goto(new URL('/', eva.url()).href);
		await eva.getByRole('button', { name: 'Start production' }).click();
		await expect(eva.getByTestId('mode')).toHaveAttribute('data-production', 'started');
		await eva.goto(new URL('/orders', eva.url()).href);
		await expect(row('Engine 4712')).toHaveAttribute('data-state', 'Running');
		await expect(row('Engine 4711')).toContainText(/Engine 4712 · [0-9a-f]{4} is in work/);
		await row('Engine 4712').getByRole('button', { name: 'Pause' }).click();
		await dialog.getByLabel('Reason').fill('A bolt is missing');
		await dialog.getByRole('button', { name: 'Pause' }).click();
		await expect(row('Engine 4712')).toHaveAttribute('data-state', 'Interrupted');
		await expect(row('Engine 4712')).toContainText('Paused: A bolt is missing');
		await row('Engine 4712').getByRole('button', { name: 'Resume' }).click();
		await dialog.getByRole('button', { name: 'Resume' }).click();
		await expect(row('Engine 4712')).toHaveAttribute('data-state', 'Running');
		await picture(eva, 'orders-1440');
		await eva.setViewportSize({ width: 320, height: 640 });
		expect(await overflow(eva), 'pixels to the right of a screen of 320').toBe(0);
		await picture(eva, 'orders-320');
		await eva.setViewportSize({ width: 1440, height: 900 });
	});

	await test.step('a viewer sees the same, and nothing to press', async () => {
		const vera = await browse(VERA, '/orders');
		await expect(row('Engine 4712', vera)).toHaveAttribute('data-state', 'Running');
		await expect(vera.getByRole('button', { name: /: Engine 4712/ })).toHaveCount(0);
		await expect(vera.getByRole('button', { name: /More for/ })).toHaveCount(0);
		await expect(vera.getByRole('button', { name: 'New order' })).toHaveCount(0);
		await expect(vera.getByTestId('by-order')).toHaveText('By order');
	});

	await test.step('it is worked to its end, and what was made is told', async () => {
		await row('Engine 4711').getByRole('button', { name: 'More for Engine 4711' }).click();
		await row('Engine 4711').getByRole('button', { name: 'Withdraw' }).click();
		await dialog.getByRole('button', { name: 'Withdraw' }).click();
		await expect(row('Engine 4711')).toHaveCount(0);
		await expect(eva.locator('[data-response]').filter({ hasText: 'Engine 4711' }), 'it stays in sight today').toContainText('withdrawn');
		const response = eva.locator('[data-response]').filter({ hasText: 'Engine 4712' });
		await doTasks(eva, async () => (await response.count()) > 0);
		await expect(response).toContainText('completed');
		await expect(eva.getByRole('region', { name: 'Over today' }).getByRole('heading')).toContainText('1');
		await store('Engine 4713', '0');
		await expect(row('Engine 4713'), 'it is known by now how long one takes').toContainText(/ready \d/);
		await expect(eva.getByTestId('order-line').getByText(/^Engine 4712 · [0-9a-f]{4}, made from/)).toBeAttached();
		await response.getByRole('button', { name: 'Engine 4712' }).click();
		const told = eva.getByRole('dialog', { name: 'Engine 4712' });
		await expect(told).toContainText('7 of 7 operations completed');
		await expect(told.locator('tbody tr')).toHaveCount(7);
		await examine(eva, 'orders-made');
		await told.getByRole('button', { name: 'Clear' }).click();
		await dialog.getByRole('button', { name: 'Clear' }).click();
		await expect(response).toHaveCount(0);
	});

	await test.step('how long it took is told beside the median, drawn and as a table', async () => {
		await eva.goto(new URL('/', eva.url()).href);
		const cycle = eva.locator('[data-figure="cycle"]').getByRole('button');
		await cycle.press('Enter');
		const drawer = eva.getByRole('dialog', { name: 'Cycle time' });
		await expect(drawer.getByRole('img').locator('canvas')).toBeVisible();
		await examine(eva, 'cycle-times');
		await drawer.getByRole('button', { name: 'as table' }).click();
		await expect(drawer.getByRole('row').nth(1)).toHaveText(/The last one\s*(\d+:)?\d+:\d\d\s*±0:00/);
		await eva.keyboard.press('Escape');
		await expect(cycle).toBeFocused();
	});
	expect(complaints).toEqual([]);
});

test('another system is told of orders: made by an administrator, signed, seen to be delivered, and deleted', async ({ browse, complaints }) => {
	const heard: { readonly kind: string; readonly signature: string }[] = [];
	const other = createServer((request, response) => {
		let body = '';
		request.on('data', (part: Buffer) => (body += part.toString()));
		request.on('end', () => {
			heard.push({ kind: (JSON.parse(body) as { kind: string }).kind, signature: String(request.headers['webhook-signature']) });
			response.writeHead(204).end();
		});
	});
	await new Promise<void>((listens) => other.listen(PORT, '127.0.0.1', listens));
	try {
		const ada = await browse(ADA, '/webhooks');
		const make = async (name: string, url: string): Promise<void> => {
			await ada.getByLabel('Name').fill(name);
			await ada.getByLabel('Where events are sent to').fill(url);
			await ada.getByRole('button', { name: 'Make', exact: true }).click();
		};
		await make('MES', 'https://mes.example/events');
		await expect(ada.getByRole('region', { name: 'A new webhook' }).getByRole('alert')).toContainText('mes.example');
		await expect(ada.getByLabel('Where events are sent to')).toHaveValue('https://mes.example/events');
		await make('MES', `http://127.0.0.1:${PORT}/events`);
		await expect(ada.getByRole('group', { name: 'Secret with which deliveries are signed' })).toContainText('whsec_');
		await examine(ada, 'webhooks');
		await ada.getByRole('button', { name: 'I have kept it' }).click();

		const eva = await browse(EVA, '/orders');
		await eva.getByRole('button', { name: 'New order' }).click();
		await eva.getByRole('dialog', { name: 'New order' }).getByLabel('Description').fill('Told');
		await eva.getByRole('checkbox', { name: /^Release it/ }).uncheck();
		await eva.getByRole('button', { name: 'Add order' }).click();
		await expect.poll(() => heard.map(({ kind }) => kind), { timeout: 15_000 }).toContain('job-order-stored');
		expect(heard[0]?.signature).toMatch(/^v1,/);
		await expect(ada.locator('[data-webhook="MES"]')).toContainText('all is delivered');
		await eva.getByRole('button', { name: 'More for Told' }).click();
		await eva.getByRole('button', { name: 'Withdraw order: Told' }).click();
		await eva.getByRole('dialog').getByRole('button', { name: 'Withdraw' }).click();

		await ada.getByRole('button', { name: 'Delete MES' }).click();
		await ada.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
		await expect(ada.getByText('Nobody is told')).toBeVisible();
		// A refusal is what a browser writes down about a request that was answered so.
		expect(complaints.filter((each) => !each.includes('422'))).toEqual([]);
	} finally {
		await new Promise((ended) => other.close(ended));
	}
});
