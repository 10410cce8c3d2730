/**
 * From a fault to production again by what the page says: six faults at each of two stations, and six stories of an operator
 * with every press counted.
 */
import { Back, served, type Hands } from '../../station/back-to-work.ts';
import { Clicks } from '../../station/clicks.ts';
import { Judged } from '../../station/judged.ts';
import { acknowledge, completed, picture, takeControl, variable } from '../../station/seen.ts';
import type { Station } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';
import type { Locator, Page } from '@playwright/test';

interface Place {
	readonly station: Station;
	readonly operate: Page;
	readonly state: Page;
	readonly watch: Page;
	readonly restart: Page;
	readonly plant: Plant;
}

/** What stories need to know of a station. */
interface Plant {
	readonly model: string;
	/** A pair of bolts that is told of, and the pose at it. */
	readonly pairs: readonly string[];
	/** How the tool is told to run. */
	readonly turning: string;
	/** A pose that no story of the pair has. */
	readonly aside: string;
}

const PLANTS: readonly Plant[] = [
	{
		model: 'bolt_tightening',
		pairs: ['bolt_pair_1', 'bolt_pair_2', 'bolt_pair_3'],
		turning: 'nutrunner.tool_is_running_forward',
		aside: 'home'
	},
	{
		model: 'truck_engine_station',
		pairs: [1, 2, 3, 4, 5, 6].map((n) => `AtBoltPair${n}TCPPose`),
		turning: 'nutrunner.tool_is_running_forward',
		aside: 'HomeJOINTPose'
	}
];

interface Story {
	readonly name: string;
	/** Something goes wrong at a station that works. */
	readonly strike: (at: Place) => Promise<void>;
	/** What a person does at the devices as soon as the page asks them for something there. */
	readonly hands: (at: Place) => Hands;
	/** It is over only when bolts are tightened again, be it without anybody. */
	readonly bolts?: true;
	/** What a person knows better, and corrects before they look at Restart. */
	readonly corrects?: (at: Place) => Promise<void>;
}

const shows = (page: Page, name: string, value: string): Promise<boolean> =>
	variable(page, name)
		.getAttribute('data-value')
		.then((seen) => seen === value);

/** How often bolts were tightened, over all pairs. */
async function tightenings({ operate, plant }: Place): Promise<number> {
	const each = await Promise.all(plant.pairs.map((pair) => completed(operate, `tighten_bolt_pair(${pair})`)));
	return each.reduce((sum, n) => sum + n, 0);
}

/** The robot is told to go down to placed bolts. */
async function goesDown(at: Place): Promise<void> {
	const { state, watch, plant } = at;
	await served(
		watch,
		async () => {
			const target = (await variable(state, 'robot.target_pose').getAttribute('data-value')) ?? '';
			return plant.pairs.includes(target) && (await shows(state, `bolts[${target}]`, 'placed'));
		},
		240
	);
}

/** It is there with the tool turning, for so long that what strikes then strikes while it does. */
async function tightens(at: Place): Promise<void> {
	const { state, watch, plant, station } = at;
	await goesDown(at);
	await station.fault('nutrunner slow 10');
	await served(
		watch,
		async () => {
			const pose = (await variable(state, 'robot.pose').getAttribute('data-value')) ?? '';
			return plant.pairs.includes(pose) && (await shows(state, plant.turning, 'true'));
		},
		120
	);
}

const mends = ({ station }: Place): Hands => ({ mend: () => station.fault('clear'), truth: 'placed' });

const MOVED: Story = {
	name: 'the robot is moved by hand',
	strike: async (at) => {
		await tightens(at);
		await at.station.byHand(`robot.pose := ${at.plant.aside}`);
		await at.station.fault('clear');
	},
	hands: mends,
	bolts: true
};

/** The tool gets stuck on the bolts. */
const stuck: Story['strike'] = async (at) => {
	await tightens(at);
	await at.station.fault('clear');
	await at.station.fault('nutrunner stuck');
};

const STORIES: readonly Story[] = [
	{
		name: 'the robot is stuck on its way to placed bolts',
		strike: async (at) => {
			await goesDown(at);
			await at.station.fault('robot stuck');
		},
		hands: mends
	},
	{ name: 'the nutrunner fails on the bolts', strike: stuck, hands: mends },
	{
		name: 'the robot is dead, and comes back',
		strike: async (at) => {
			await goesDown(at);
			await at.station.fault('robot offline');
		},
		hands: mends
	},
	MOVED,
	{
		name: 'held in the middle of the bolts',
		strike: async (at) => {
			await tightens(at);
			await at.restart.getByRole('button', { name: 'Hold', exact: true }).click();
			await at.station.fault('clear');
		},
		hands: mends
	},
	{
		name: 'the controller is killed in the middle of the bolts',
		strike: async (at) => {
			await tightens(at);
			at.station.server.killPart('controller');
			await at.station.fault('clear');
		},
		hands: mends
	}
];

/** Milliseconds from a fault until bolts are tightened again. */
const LONGEST = 300_000;

/** A story by a part of its name; all without. */
const NAMED = process.env['STORY'] ?? '';

for (const plant of PLANTS)
	test.describe(plant.model, () => {
		test.use({ shared: null, copied: plant.model });

		for (const { name, strike, hands } of STORIES.filter((each) => each.name.includes(NAMED)))
			test(`${name}, and the page leads back to production @long`, async ({ operate, state, watch, station }) => {
				test.setTimeout(600_000);
				await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'started', { timeout: 120_000 });
				await takeControl(operate);
				const restart = await operate.context().newPage();
				restart.setDefaultTimeout(15_000);
				const judged = new Judged(restart);
				await restart.goto(new URL('/restart', operate.url()).href);
				await expect(restart.getByTestId('next-act')).toBeAttached();
				const at: Place = { station, operate, state, watch, restart, plant };
				await strike(at);
				// What nobody need do anything about is over by itself.
				const before = await tightenings(at);
				const back = new Back(restart, hands(at), 90_000);
				const goesOn = async (): Promise<boolean> => (await tightenings(at)) > before;
				const end = Date.now() + LONGEST;
				try {
					// It takes some time until the page knows of it; until then it says that there is nothing to do.
					while (!(await goesOn())) {
						expect(Date.now(), `after ${back.acts.join(', ')}`).toBeLessThan(end);
						await back.toWork();
						await served(watch, goesOn, 2).catch(() => undefined);
					}
				} finally {
					await judged.look(watch);
					test.info().annotations.push(
						{ type: 'acts', description: back.acts.join(', ') },
						{ type: 'proposed', description: judged.proposed.join(' | ') }
					);
					await picture(restart, `story-${plant.model}-${name.replaceAll(/\W+/g, '-')}`);
				}
				expect(judged.wrong).toEqual([]);
			});
	});

/** So often does an operator press at most, from the alarm to production again, with the way to the page and control. */
const MOST_PRESSES = 6;

/** What says beside the name of the page Restart that somebody is needed. */
const marked = (page: Page): Locator => page.locator('nav a[href="/restart"] .badge').first();

const asked = async ({ state }: Place): Promise<string> =>
	(await variable(state, 'operator.requested_pair').getAttribute('data-value')) ?? '';

/** The bolts that the operator is asked for are believed to be there, and the station goes on. */
async function slipped(at: Place): Promise<void> {
	const { state, watch, plant, restart } = at;
	const isEmpty = (pair: string): Promise<boolean> => shows(state, `bolts[${pair}]`, 'empty');
	let pair: string;
	let others: boolean[];
	do {
		// A task that nobody has done yet; not for the last bolts, with which the engine would be finished.
		await served(watch, async () => (await asked(at)) === 'none', 60);
		await expect.poll(() => asked(at), { timeout: 60_000 }).not.toBe('none');
		pair = await asked(at);
		others = await Promise.all(plant.pairs.filter((each) => each !== pair).map(isEmpty));
	} while (!others.some(Boolean));
	await slip(at, `bolts[${pair}]`, 'placed');
	// Until the station asks nobody does the task, which would make true what somebody has said.
	await expect(marked(restart)).toBeVisible({ timeout: 15_000 });
}

/** The operator is asked for bolts that are there, and tells so on the watch. */
async function askedAgain(at: Place): Promise<void> {
	const { state, watch, plant, restart } = at;
	/** Bolts that wait for the robot, which is at others: what it and the tool do says nothing of them. */
	const waiting = async (): Promise<string | undefined> => {
		const placed = await Promise.all(plant.pairs.map((pair) => shows(state, `bolts[${pair}]`, 'placed')));
		const target = await variable(state, 'robot.target_pose').getAttribute('data-value');
		return placed.filter(Boolean).length > 1 ? plant.pairs.find((pair, n) => placed[n] && pair !== target) : undefined;
	};
	let pair: string | undefined;
	await served(watch, async () => (pair = await waiting()) !== undefined, 120);
	await slip(at, `bolts[${pair ?? ''}]`, 'empty');
	await served(watch, async () => (await asked(at)) === pair, 120);
	await watch.locator('button[data-problem]').tap();
	await watch.locator('button[data-wrong="other"]').tap();
	await expect(marked(restart)).toBeVisible({ timeout: 15_000 });
}

/** The task can be done after all, and is. */
async function solved({ watch }: Place): Promise<void> {
	await watch.locator('button[data-problem]').tap();
	await acknowledge(watch);
}

/** They are there: at the page State, with a reason. */
async function corrected(at: Place): Promise<void> {
	const { restart } = at;
	await restart.locator('nav a[href="/state"]').first().click();
	const row = restart.locator(`[data-row="bolts[${await asked(at)}]"]`);
	await row.getByRole('button', { name: /^Correct…/ }).click();
	const drawer = restart.getByRole('dialog');
	await drawer.getByRole('radio', { name: 'placed' }).check();
	await drawer.getByLabel('Reason').fill('They are in their holes');
	await drawer.getByRole('button', { name: 'Correct to placed' }).click();
	await expect(drawer).toHaveCount(0);
	await solved(at);
}

const COUNTED: readonly Story[] = [
	{
		name: 'devices are dead, and come back',
		strike: async ({ station }) => {
			await station.fault('robot offline');
		},
		hands: mends
	},
	{
		name: 'held, and on again',
		strike: async ({ restart }) => {
			await restart.getByRole('button', { name: 'Hold', exact: true }).click();
		},
		hands: mends
	},
	MOVED,
	{ name: 'the tool gives no torque', strike: stuck, hands: mends, bolts: true },
	{
		name: 'a bolt has fallen out',
		strike: slipped,
		hands: (at) => ({ ...mends(at), truth: 'empty' }),
		bolts: true
	},
	{
		name: 'what is believed is wrong',
		strike: askedAgain,
		corrects: corrected,
		hands: (at) => ({ ...mends(at), truth: 'placed' }),
		bolts: true
	}
];

/** Somebody says what is not so, and lets the station go on. */
async function slip({ restart, station }: Place, name: string, value: string): Promise<void> {
	const send = async (method: 'POST' | 'PUT' | 'DELETE', path: string, data: object): Promise<unknown> => {
		const answer = await restart.request.fetch(`${station.url}/api/v1/${path}`, { method, data });
		expect(answer.ok(), `${path}: ${await answer.text()}`).toBe(true);
		return answer.status() === 204 ? null : answer.json();
	};
	await send('PUT', 'control-lock', { over: null });
	await send('POST', 'restart/enter', {});
	await expect(async () => {
		const { revision } = (await send('POST', 'corrections/preview', { values: { [name]: value } })) as { revision: number };
		await send('POST', 'corrections', { values: { [name]: value }, revision, reason: 'a slip' });
	}).toPass({ timeout: 15_000 });
	await send('POST', 'restart/leave', {});
	await send('PUT', 'mode', { mode: 'automatic' });
	await send('DELETE', 'control-lock', {});
}

/** The operator's page on which presses are counted, and all that stories need. */
async function counted(operate: Page, state: Page, watch: Page, station: Station, plant: Plant): Promise<{ at: Place; clicks: Clicks }> {
	await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'started', { timeout: 120_000 });
	const restart = await operate.context().newPage();
	restart.setDefaultTimeout(30_000);
	const clicks = await Clicks.on(restart);
	await restart.goto(new URL('/alarms', operate.url()).href);
	return { at: { station, operate, state, watch, restart, plant }, clicks };
}

/** One story: what goes wrong, then from another page by what the pages say, until the station works by itself. */
async function told({ at, clicks }: { at: Place; clicks: Clicks }, { strike, hands, bolts, corrects }: Story): Promise<string> {
	const { restart, watch } = at;
	await restart.goto(new URL('/alarms', restart.url()).href);
	const link = restart.locator('nav a[href="/restart"]').first();
	await strike(at);
	const before = await tightenings(at);
	const tightened = async (): Promise<boolean> => (await tightenings(at)) > before;
	// The mark at the page says that somebody is needed.
	await served(watch, async () => (await marked(restart).isVisible()) || (bolts === true && (await tightened())), 60);
	clicks.clear();
	await corrects?.(at);
	await link.click();
	await expect(restart.getByTestId('next-act')).toBeAttached();
	const back = new Back(restart, hands(at), 60_000);
	const works = async (): Promise<boolean> =>
		(await restart.getByTestId('next-act').getAttribute('data-next')) === 'nothing' &&
		(await at.operate.getByTestId('mode').getAttribute('data-production')) === 'started' &&
		(bolts === undefined || (await tightened()));
	const end = Date.now() + LONGEST;
	do {
		expect(Date.now(), `after ${back.acts.join(', ')}`).toBeLessThan(end);
		await back.toWork();
		await served(watch, works, 2).catch(() => undefined);
	} while (!(await works()));
	const said = `${clicks.presses} presses, ${clicks.decisions} decisions: ${clicks.pressed.join(' > ')}`;
	expect.soft(clicks.presses, said).toBeLessThanOrEqual(MOST_PRESSES);
	// Control is given back, so that the next one has to take it too.
	const release = restart.getByRole('button', { name: 'Release control' });
	if (await release.isVisible()) await release.click();
	return said;
}

const [SMALL, TRUCK] = PLANTS;

for (const [plant, title, stories] of [
	[TRUCK, 'devices dead and back, and held: few presses to production @long', COUNTED.slice(0, 2)],
	// All of a large station that never goes together is known only after minutes; the small one asks at once.
	[SMALL, 'six stories, each with few presses to production @long', COUNTED.filter((each) => each.name.includes(NAMED))]
] as const)
	test.describe('an operator by pages alone', () => {
		if (plant === undefined) throw new Error('no such station');
		test.use({ shared: null, copied: plant.model });

		test(title, async ({ operate, state, watch, station }) => {
			test.setTimeout(60_000 + stories.length * 120_000);
			const given = await counted(operate, state, watch, station, plant);
			for (const story of stories)
				await test.step(story.name, async () => {
					test.info().annotations.push({ type: story.name, description: await told(given, story) });
				});
		});
	});
