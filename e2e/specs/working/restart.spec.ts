import type { APIResponse, Page } from '@playwright/test';
import { Back, served, type Hands } from '../../station/back-to-work.ts';
import { examine } from '../../station/barriers.ts';
import { acknowledge, done, picture, restsOnPerson, takeControl, tightenings, variable } from '../../station/seen.ts';
import type { Station } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

/** The page Restart in the same browser as Operate: the same session, with the same control. */
async function openRestart(operate: Page): Promise<Page> {
	const page = await operate.context().newPage();
	page.setDefaultTimeout(15_000); // what cannot be pressed shall not use up the time of the others
	await page.goto(new URL('/restart', operate.url()).href);
	await expect(page.getByTestId('next-act')).toBeAttached();
	return page;
}

test('held, into restart mode and out of it, each by an act of its own, and work goes on', async ({ operate, watch }) => {
	const mode = operate.getByTestId('mode');
	const notice = operate.getByTestId('restart-notice');
	const main = operate.locator('main');
	const press = (name: string) => operate.getByRole('button', { name, exact: true });
	const act = (name: string) => main.getByRole('button', { name, exact: true });
	await restsOnPerson(operate, watch);
	await expect(notice).toBeHidden(); // as long as the station works by itself
	const before = await tightenings(operate);
	await takeControl(operate);

	await test.step('Hold is one press, and a second on the same place does no harm', async () => {
		await press('Hold').click();
		await expect(mode).toContainText('Hold');
		await press('Hold').click({ force: true });
		await expect(press('Continue')).toBeVisible();
		await expect(notice).toContainText('Nothing starts');
		await picture(operate, 'operate-held');
		await notice.locator('a[href="/restart"]').click();
	});

	await test.step('in restart mode operations wait, and there is no way on but out of it', async () => {
		// Held, it could go on as it is; whoever wants to look first enters restart mode all the same.
		await expect(operate.getByTestId('next-act')).toHaveAttribute('data-next', 'continue');
		await act('Enter restart mode').click();
		await expect(mode).toContainText('Restart');
		await expect(operate.getByTestId('strip').getByRole('button', { name: 'Continue' })).toBeHidden();
		await expect(operate.getByTestId('next-act')).toHaveAttribute('data-next', 'leave');
		await expect(act('Continue')).toHaveCount(0);
		await main.getByRole('button', { name: /Choose a way back/ }).click();
		await expect(operate.getByTestId('offers')).toContainText('Go on as it is');
		await acknowledge(watch);
		await operate.waitForTimeout(2000);
		await main.getByRole('button', { name: /Understand/ }).click();
		await expect(operate.getByTestId('moves')).toContainText('Nothing is running');
		await picture(operate, 'restart');
		await operate.getByRole('link', { name: 'Operate' }).click();
		await expect(operate.locator('[data-status="running"]')).toHaveCount(0);
		expect(await tightenings(operate)).toBe(before);
		await expect(notice).toContainText('The station is in restart mode');
		await notice.locator('a[href="/restart"]').click();
	});

	await test.step('leaving it alone pauses', async () => {
		await act('Leave restart mode').click();
		await expect(mode).toContainText('Paused');
		await operate.waitForTimeout(1000);
		await expect(mode).toContainText('Paused');
	});

	await test.step('and Continue goes on', async () => {
		await act('Continue').click();
		await expect(mode).toContainText('Automatic');
		await expect(main).toContainText('The station works by itself');
		await operate.getByRole('link', { name: 'Operate' }).click();
		await expect(notice).toBeHidden();
		await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBe(before + 1);
	});
});

test('an operation is reset by a plan that is looked at first, and refused once the station has moved @long', async ({
	operate,
	watch,
	station
}) => {
	await restsOnPerson(operate, watch);
	await takeControl(operate);
	const pair = (await operate.locator('[data-status="running"]').getAttribute('data-step')) ?? '';
	await operate.getByRole('button', { name: 'Hold', exact: true }).click();
	await operate.goto(`${station.url}/restart`);
	const main = operate.locator('main');
	const byHand = operate.getByRole('dialog', { name: 'None of these fits' });
	const plan = byHand.getByTestId('way-plan');
	await main.getByRole('button', { name: 'Enter restart mode' }).click();
	await expect(operate.getByTestId('mode')).toContainText('Restart');

	await test.step('what is found lists each start, and is taken once that was read', async () => {
		await main.getByRole('button', { name: /Choose a way back/ }).click();
		await main.getByRole('button', { name: 'None of these fits…' }).click();
		await byHand.getByLabel('Operation').selectOption({ label: 'Prepare the planning scene' });
		await byHand.getByRole('button', { name: 'Find a plan' }).first().click();
		await expect(plan.locator('[data-start]').filter({ visible: true })).toHaveCount(1);
		await expect(plan.getByRole('button', { name: 'Reset Prepare the planning scene' })).toHaveAttribute('aria-disabled', 'true');
		await plan.getByLabel('Note for the journal').fill('to have it anew');
		await plan.getByRole('checkbox').check();
	});

	await test.step('while somebody reads, the station moves: it says so, and leads back to a fresh plan', async () => {
		await acknowledge(watch);
		await expect(plan).toContainText('The station has changed');
		await picture(operate, 'restart-moved');
		await plan.getByRole('button', { name: 'Check again' }).click();
		await plan.getByRole('checkbox').check();
		await plan.getByRole('button', { name: 'Reset Prepare the planning scene' }).click();
		await expect(byHand).toHaveCount(0); // what is carried out is seen on the page
		await main.getByRole('button', { name: /Understand/ }).click();
		await expect(operate.getByTestId('last-errand')).toContainText('Reset Prepare the planning scene');
		await expect(operate.getByTestId('last-errand')).toHaveAttribute('data-done', 'true');
		await expect(operate.getByTestId('mode')).toContainText('Restart');
	});

	await test.step('a predicate that means nothing is marked where it does not', async () => {
		await main.getByRole('button', { name: /Choose a way back/ }).click();
		await main.getByRole('button', { name: 'None of these fits…' }).click();
		await byHand.getByLabel('Predicate').fill('robot.pose == hom');
		await byHand.getByRole('button', { name: 'Find a plan' }).last().click();
		await expect(operate.getByTestId('place').locator('mark')).toHaveText('hom');
		await examine(operate, 'restart-by-hand');
		await byHand.getByRole('button', { name: 'Close' }).first().click();
	});

	await examine(operate, 'restart');
	await operate.setViewportSize({ width: 1440, height: 900 });
	await main.getByRole('button', { name: /Go on/ }).click();
	await main.getByRole('button', { name: 'Leave restart mode and continue' }).click();
	expect(pair).toContain('place_bolt_pair');
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	await operate.getByRole('button', { name: 'Release control' }).click();
});

interface Place {
	readonly station: Station;
	readonly operate: Page;
	readonly state: Page;
	readonly watch: Page;
	readonly restart: Page;
}

interface Fault {
	readonly name: string;
	/** Something goes wrong at a station that works. */
	readonly strike: (at: Place) => Promise<void>;
	/** What an alarm says of it; null where none has to, and Operate alone says that a person is wanted. */
	readonly alarm: RegExp | null;
	readonly hands: (at: Place) => Hands;
	/** What the page has a person do, among other things. */
	readonly asks: string[];
}

const clear = ({ station }: Place): Hands => ({ mend: () => station.fault('clear') });

/** An alarm on Restart whose cause is still there. */
const LASTING = '[data-happened][data-lasts="true"]';

/** The tool turns at a bolt pair. */
async function turns({ state, watch }: Place): Promise<void> {
	const turning = state.locator('[data-variable="nutrunner.tool_is_running_forward"][data-value="true"]');
	const there = state.locator('[data-variable="robot.pose"][data-value^="bolt_pair"]');
	await served(watch, async () => (await turning.count()) > 0 && (await there.count()) > 0, 40);
}

/** It does, and for so long that what strikes now strikes while it does. */
async function turnsSlowly(at: Place): Promise<void> {
	await at.station.fault('nutrunner slow 10');
	await turns(at);
}

/** Work goes on until an alarm comes. */
async function alarms({ restart, watch }: Place): Promise<void> {
	const next = restart.getByTestId('next-act');
	await served(watch, async () => (await next.getAttribute('data-next')) !== 'nothing', 40);
}

/** A bolt pair is placed, and nobody is wanted for a restart. */
async function placesBolts({ operate, state, watch }: Place): Promise<void> {
	const placed = state.locator('[data-variable^="bolts["][data-value="placed"]');
	const before = await placed.count();
	await served(watch, async () => (await placed.count()) > before, 40);
	await expect(operate.getByTestId('restart-notice')).toBeHidden();
}

/** Work goes on as long as it can, until a person is wanted for a restart. */
async function stands({ operate, watch }: Place): Promise<void> {
	await served(watch, () => operate.getByTestId('restart-notice').isVisible(), 40);
}

/** Something is believed that is not so. What still ran may end between the look and the act: then it is looked again. */
async function believe({ restart, station }: Place, name: string, value: string): Promise<void> {
	const send = (path: string, data: object): Promise<APIResponse> =>
		restart.request.post(`${station.url}/api/v1/${path}`, { data });
	const done = async (answer: APIResponse): Promise<APIResponse> => {
		expect(answer.ok(), `${answer.url()}: ${await answer.text()}`).toBe(true);
		return answer;
	};
	await done(await send('restart/enter', {}));
	await expect(async () => {
		const preview = await done(await send('corrections/preview', { values: { [name]: value } }));
		const { revision } = (await preview.json()) as { revision: number };
		await done(await send('corrections', { values: { [name]: value }, revision, reason: 'a slip' }));
	}).toPass({ timeout: 15_000 });
	await done(await send('restart/leave', {}));
}

/** Somebody takes a resource out of service. */
async function takeOut({ restart, station }: Place, resource: string): Promise<void> {
	const data = { in_service: false, reason: 'it squeaks' };
	const answer = await restart.request.put(`${station.url}/api/v1/availability/resource/${resource}`, { data });
	expect(answer.ok(), await answer.text()).toBe(true);
}

/** Puts it back as the page says. */
async function putBack({ restart }: Place, title: string): Promise<void> {
	await restart.getByRole('button', { name: `Put back: ${title}` }).first().click();
	const dialog = restart.getByRole('dialog');
	await dialog.getByLabel('Reason').fill('oiled');
	await dialog.getByRole('button', { name: 'Put back' }).click();
	await expect(dialog).toHaveCount(0);
}

/** The bolt pair that a person is asked to place. */
async function requested({ state, watch }: Place): Promise<string> {
	const pair = variable(state, 'operator.requested_pair');
	await served(watch, async () => /^bolt_pair/.test((await pair.getAttribute('data-value')) ?? ''), 40);
	return (await pair.getAttribute('data-value')) ?? '';
}

const FAULTS: readonly Fault[] = [
	{
		name: 'a device is gone',
		strike: ({ station }) => station.fault('robot offline'),
		alarm: /Nothing heard from/,
		hands: clear,
		asks: ['physical']
	},
	{
		name: 'held in the middle of a bolt',
		strike: async (at) => {
			await turnsSlowly(at);
			await at.restart.getByRole('button', { name: 'Hold', exact: true }).click();
			await at.station.fault('clear');
		},
		alarm: /outside its safe states/,
		hands: clear,
		asks: ['enter', 'take', 'leave', 'continue']
	},
	{
		name: 'what is believed is wrong',
		strike: async (at) => believe(at, `bolts[${await requested(at)}]`, 'placed'),
		alarm: /It is believed that .* is placed/,
		hands: () => ({ mend: () => Promise.resolve(), truth: 'empty' }),
		asks: ['enter', 'answer', 'leave', 'continue']
	},
	{
		name: 'the controller dies',
		strike: ({ station }) => Promise.resolve(station.server.killPart('controller')),
		alarm: null,
		hands: clear,
		asks: ['start']
	},
	{
		name: 'a sensor says what is not true',
		strike: async (at) => {
			await at.station.fault('nutrunner.tool_is_idle wrong false');
			await alarms(at);
		},
		alarm: /./,
		hands: clear,
		asks: []
	},
	{
		name: 'a device does nothing more',
		strike: async (at) => {
			await at.station.fault('nutrunner slow 10000');
			await alarms(at);
		},
		alarm: /./,
		hands: clear,
		asks: []
	},
	{
		name: 'a device is gone in the middle of a bolt',
		strike: async (at) => {
			await turnsSlowly(at);
			await at.station.fault('nutrunner offline');
		},
		alarm: /Nothing heard from Nutrunner/,
		hands: clear,
		asks: []
	},
	{
		name: 'a device is out of service',
		strike: async (at) => {
			await requested(at);
			await takeOut(at, 'robot');
			await placesBolts(at);
			await stands(at);
			await expect(at.operate.getByTestId('restart-notice')).toContainText('Out of service: Robot UR10.');
		},
		alarm: null,
		hands: (at) => ({ mend: () => putBack(at, 'Robot UR10') }),
		asks: ['physical']
	},
	{
		name: 'a device talks nonsense',
		strike: async (at) => {
			await turnsSlowly(at);
			await at.station.fault('nutrunner garbage');
		},
		alarm: /\/smart_nutrunner\/state: not a /,
		hands: clear,
		asks: []
	},
	{
		name: 'a device begins anew in the middle of a bolt',
		strike: async (at) => {
			await turnsSlowly(at);
			await at.station.fault('robot restarted for 15 s');
			await at.station.fault('clear nutrunner'); // the bolt is tight before the robot is there again
		},
		alarm: /Nothing heard from Robot UR10/,
		hands: () => ({ mend: () => Promise.resolve(), truth: 'tightened' }), // it comes back by itself
		asks: []
	}
];

/** So many of them are gone through, all of them in a campaign; or those alone whose names have `FAULT` in them. */
const NUMBER = Number(process.env['FAULTS'] ?? 1);
const NAMED = process.env['FAULT'];
const CHOSEN = NAMED === undefined ? FAULTS.slice(0, NUMBER) : FAULTS.filter(({ name }) => name.includes(NAMED));

test.describe('a station of its own', () => {
	test.use({ shared: null });

	test('from an alarm to production again, by this page alone', async ({ operate, state, watch, station }) => {
		test.setTimeout(60_000 + CHOSEN.length * 60_000);
		await restsOnPerson(operate, watch);
		await takeControl(operate);
		const restart = await openRestart(operate);
		const at: Place = { station, operate, state, watch, restart };
		const wrong: string[] = [];
		for (const { name, strike, alarm, hands, asks } of CHOSEN)
			await test.step(name, async () => {
				const back = new Back(restart, hands(at));
				try {
					await strike(at);
					const said = restart.locator(LASTING).filter(alarm === null ? {} : { hasText: alarm });
					if (alarm !== null) {
						await restart.getByRole('button', { name: /Understand/ }).click();
						await expect(said.first()).toBeVisible();
					}
					await expect(operate.getByTestId('restart-notice')).toBeVisible();
					await back.toWork();
					expect(back.acts).toEqual(expect.arrayContaining(asks));
					const before = await tightenings(operate);
					await served(watch, async () => (await tightenings(operate)) > before, 60);
				} catch (error) {
					// The others are gone through all the same.
					wrong.push(`${name} (${back.acts.join(', ')}): ${String(error)}`);
					await picture(restart, `restart-fault-${wrong.length}`);
					await station.fault('clear');
					await back.toWork().catch(() => undefined);
				}
				test.info().annotations.push({ type: name, description: back.acts.join(', ') });
			});
		expect(wrong).toEqual([]);
	});
});
