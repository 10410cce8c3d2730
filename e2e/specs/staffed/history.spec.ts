import { readFile } from 'node:fs/promises';
import { examine, findings } from '../../station/barriers.ts';
import { acknowledge, restsOnPerson } from '../../station/seen.ts';
import { VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

/** The first look back prepares the station, with what the machine has to spare. */
const PREPARED = { timeout: 60_000 };

interface Told {
	readonly record: { readonly number: number; readonly hash: string };
	readonly past: { readonly values: Record<string, unknown> };
}

test('the station is seen as it was, step by step, and taken along @long', async ({ operate, watch }) => {
	const slider = operate.getByRole('slider', { name: 'Moment that is shown' });
	const past = operate.getByTestId('past');
	const state = operate.getByRole('region', { name: 'State then and now' });
	const chosen = operate.locator('.entry button[aria-pressed="true"]');

	await test.step('some work is done, of which the time line tells', async () => {
		await acknowledge(watch);
		await operate.getByRole('link', { name: 'History' }).click();
		await expect(operate.locator('[data-lane="of robot"] .bar')).not.toHaveCount(0);
		await expect(past).toHaveCount(0);
	});

	const number = await test.step('the keyboard leads to an earlier record', async () => {
		await slider.press('Home');
		await expect(past).toHaveAttribute('data-record', '1');
		await slider.press('Shift+ArrowRight');
		await slider.press('ArrowLeft');
		await expect(past).toHaveAttribute('data-record', '10');
		await expect(slider).toHaveAttribute('aria-valuenow', '10');
		await expect(slider).toHaveAttribute('aria-valuetext', /record 10$/);
		await expect(operate).toHaveURL(/record=10$/);
		await expect(past.getByRole('heading', { name: /^Past: / })).toBeAttached();
		await expect(past.getByText(/, not now$/)).toBeVisible();
		return 10;
	});

	const told = await test.step('the state there is what the server says of it, and not that of now', async () => {
		const told = await operate.evaluate(
			async (n) => (await (await fetch(`/api/v1/history/${n}`)).json()) as Told,
			number
		);
		await expect(past).toHaveAttribute('data-shown', String(number), PREPARED);
		await expect(past.getByTestId('past-picture').locator('[data-symbol]')).not.toHaveCount(0);
		await state.getByRole('button', { name: /^All/ }).click();
		await expect(state.locator('[data-then]')).not.toHaveCount(0);
		const shown = await state.locator('[data-then]').evaluateAll((all) =>
			all.map((each) => [each.getAttribute('data-then') ?? '', each.getAttribute('data-value')] as const)
		);
		expect(shown.length).toBeGreaterThan(5);
		for (const [name, value] of shown) expect(String(told.past.values[name]), name).toBe(value);
		await state.getByRole('button', { name: /^Different/ }).click();
		await expect(state.locator('[data-then]')).not.toHaveCount(0);
		await expect(state.locator('[data-then]:not(.was)'), 'only what differs').toHaveCount(0);
		return told;
	});

	await test.step('the list shows the same record, and only what is sought', async () => {
		await operate.getByRole('button', { name: 'Filter the events' }).click();
		await operate.getByLabel('What', { exact: true }).selectOption('every record');
		await expect(chosen).toHaveAttribute('data-record', String(number));
		await operate.getByLabel('What', { exact: true }).selectOption('starts of the controller');
		const rows = operate.getByRole('list', { name: 'What happened, the newest first' }).locator('.entry');
		await expect(rows).toHaveCount(1);
		await expect(rows).toContainText('Controller started');
		await rows.getByRole('button').click();
		await expect(past).toHaveAttribute('data-record', '1');
	});

	await test.step('what is exported has the record as it was written', async () => {
		await operate.getByRole('button', { name: 'Export', exact: true }).click();
		const [download] = await Promise.all([
			operate.waitForEvent('download'),
			operate.getByRole('link', { name: 'Export everything' }).click()
		]);
		await operate.keyboard.press('Escape');
		const lines = (await readFile(await download.path(), 'utf8')).trimEnd().split('\n');
		const record = JSON.parse(lines[number - 1] ?? '') as Told['record'];
		expect(record).toMatchObject({ number, hash: told.record.hash });
	});

	await test.step('what would have been is simulated', async () => {
		await operate.getByRole('button', { name: 'What if, from here' }).click();
		await operate.getByLabel('Seconds to go on').fill('2');
		await operate.getByRole('button', { name: 'Simulate' }).click();
		await expect(operate.getByText('2 s of simulated time')).toBeVisible(PREPARED);
		await operate.keyboard.press('Escape');
	});

	await test.step('the past is played on from there, and stopped', async () => {
		await operate.getByRole('button', { name: '16×' }).click();
		await operate.getByRole('button', { name: 'Play', exact: true }).click();
		await expect.poll(async () => Number(await past.getAttribute('data-record')), PREPARED).toBeGreaterThan(1);
		// It may have come to the end by itself.
		if (await operate.getByRole('button', { name: 'Stop playing' }).isVisible()) await operate.getByRole('button', { name: 'Stop playing' }).click({ timeout: 2000 }).catch(() => undefined);
		await expect(operate.getByRole('button', { name: 'Play', exact: true })).toBeVisible(PREPARED);
	});

	await test.step('all that was recorded can be in sight', async () => {
		// The record is shorter than most of the lengths.
		await operate.getByRole('button', { name: 'All', exact: true }).click();
		await expect(operate.getByRole('button', { name: 'All', exact: true })).toHaveAttribute('aria-pressed', 'true');
		await expect(operate.getByTestId('whole').locator('.brush')).toBeVisible();
	});

	await test.step('one press leads back to now', async () => {
		await operate.getByRole('button', { name: 'Back to now' }).click();
		await expect(past).toHaveCount(0);
		await expect(operate).toHaveURL(/history$/);
	});
});

test('a link leads to a moment, and nobody is kept from it @long', async ({ operate, watch, station }) => {
	await restsOnPerson(operate, watch); // before that nothing may be recorded
	await operate.goto(`${station.url}/history?record=3`);
	await expect(operate.getByTestId('past')).toHaveAttribute('data-record', '3');
	await expect(operate.getByTestId('past')).toHaveAttribute('data-shown', '3', PREPARED);
	await test.step('the picture, what it has no room for and what happened are in sight without scrolling', async () => {
		const body = operate.getByTestId('past').locator('section > .body');
		await expect(body.locator('svg [data-symbol]')).not.toHaveCount(0);
		expect(await body.evaluate((element) => element.scrollHeight - element.clientHeight)).toBeLessThanOrEqual(1);
	});
	await examine(operate, 'history');
});

test('in the hand the page alone is scrolled, with all that is on it', async ({ operate, watch, station }) => {
	await restsOnPerson(operate, watch);
	await operate.setViewportSize({ width: 390, height: 844 });
	await operate.goto(`${station.url}/history`);
	await operate.getByRole('list', { name: 'What happened, the newest first' }).scrollIntoViewIfNeeded();
	await expect(operate.locator('[data-record]')).not.toHaveCount(0);
	const scrolled = await operate.evaluate(() => {
		const scrolls = (element: Element): boolean => /auto|scroll/.test(getComputedStyle(element).overflowY) && element.scrollHeight > element.clientHeight + 1;
		return [...document.querySelectorAll('main *')].filter(scrolls).map((element) => `${element.tagName}.${element.className}`);
	});
	expect(scrolled).toEqual([]);
	expect(await findings(operate)).toEqual([]);
});

test.describe('who only looks', () => {
	test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

	test('is told that the past needs another role', async ({ browse }) => {
		const page = await browse(VERA, '/history');
		await expect(page.getByRole('heading', { name: 'This page needs the role operator' })).toBeVisible();
		await expect(page.getByRole('link', { name: 'History' })).toHaveCount(0);
	});
});
