/** The test function of all specs: with a station, an operator's page and a watch. */
import { test as base, expect, type BrowserContext, type BrowserContextOptions, type Page } from '@playwright/test';
import { join } from 'node:path';
import { Bench } from './bench.ts';
import { Drafting } from './drafting.ts';
import { ADA, ADAM, ERIK, EVA, INA, IVO, Station, VERA, type Person } from './station.ts';

/** Who can sign in: where anybody else can, the administrator is the first. */
const PEOPLE = { nobody: [], Eva: [EVA], everybody: [ADA, EVA, ADAM, ERIK, INA, IVO, VERA] } as const;

interface Given {
	/** Name of the station to share with the other tests of that name; null for one of the test's own. */
	shared: string | null;
	/** Whether the station starts with devices and production (the default), or waits for the test to do so. */
	byItself: boolean;
	/** Whether emulated devices run beside a station that waits for the test. */
	devices: boolean;
	/** Who can sign in at a station that waits for the test. */
	people: keyof typeof PEOPLE;
	/** Further variables of the environment in which the station is started. */
	environment: Readonly<Record<string, string>>;
	/**
	 * The model of which a station has a copy that may be changed; null where it only reads the usual one. The draft of a
	 * station that is shared is as before after each test.
	 */
	copied: string | null;
	station: Station;
	/** The draft of a station whose model may be changed, as Erik edits it over REST. */
	drafting: Drafting;
	/** Opens a page in a browser of its own, signed in as somebody or as nobody. */
	browse: (person: Person | null, address: string, screen?: Screen) => Promise<Page>;
	/** The operator's page. */
	operate: Page;
	/** State, so high that every variable is in sight. */
	state: Page;
	/** The watch page on a round watch of 192 dp. */
	watch: Page;
	/** What the browser found wrong on all pages: script errors, refused content, failed requests. */
	complaints: string[];
}

type Screen = Pick<BrowserContextOptions, 'viewport' | 'deviceScaleFactor' | 'hasTouch' | 'locale'>;
type Theme = 'light' | 'dark';

export const DESK: Screen = { viewport: { width: 1440, height: 900 } };
/** As high as the table of a station's variables is. */
const HIGH: Screen = { viewport: { width: 1440, height: 2400 } };
/** A round watch of 192 dp. */
export const WRIST: Screen = { viewport: { width: 192, height: 192 }, deviceScaleFactor: 2, hasTouch: true };

function listen(page: Page, complaints: string[]): void {
	page.on('console', (message) => {
		if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
	});
	page.on('pageerror', (error) => complaints.push(error.message));
}

/** Gives a browser a new session of somebody. */
async function enter(context: BrowserContext, station: Station, person: Person): Promise<void> {
	await context.addCookies([{ ...(await station.signIn(person)), url: station.url }]);
}

/** Folder for the output of a station's processes. */
function logsOf(name: string): string {
	return join(import.meta.dirname, '../artefacts/logs', name.replace(/[^\w]+/g, '-'));
}

export const test = base.extend<Given, { bench: Bench }>({
	shared: ['at work', { option: true }],
	byItself: [true, { option: true }],
	devices: [false, { option: true }],
	people: ['Eva', { option: true }],
	environment: [{}, { option: true }],
	copied: [null, { option: true }],
	complaints: async ({}, use) => {
		await use([]);
	},
	bench: [
		async ({}, use) => {
			const bench = new Bench();
			await use(bench);
			await bench.clear();
		},
		{ scope: 'worker' }
	],
	station: [
		async ({ bench, shared, byItself, devices, people, environment, copied }, use, info) => {
			const name = shared ?? info.titlePath.join(' ');
			const logs = logsOf(`${name} ${info.project.name}`);
			const given = { byItself, devices, people: PEOPLE[people], environment, copied, logs };
			const station = shared === null ? await Station.start(given) : await bench.kept(shared, given);
			const drafting = shared === null || copied === null ? null : await Drafting.of(station);
			const before = await drafting?.files();
			await use(station);
			if (before) await drafting?.restore(before);
			if (shared === null) await station.stop();
		},
		{ timeout: 90_000 }
	],
	drafting: async ({ station }, use) => {
		await use(await Drafting.of(station));
	},
	operate: async ({ page, station, byItself, complaints }, use) => {
		listen(page, complaints);
		if (!byItself) await enter(page.context(), station, EVA);
		await page.goto(`${station.url}/`);
		await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
		await expect(page.getByTestId('not-live')).toBeHidden();
		await use(page);
	},
	browse: async ({ browser, station, colorScheme, complaints }, use) => {
		const contexts: BrowserContext[] = [];
		await use(async (person, address, screen = DESK) => {
			const theme: Theme = colorScheme === 'dark' ? 'dark' : 'light';
			const context = await browser.newContext({ ...screen, baseURL: station.url, colorScheme: theme });
			contexts.push(context);
			if (person) await enter(context, station, person);
			const page = await context.newPage();
			listen(page, complaints);
			await page.goto(address);
			return page;
		});
		await Promise.all(contexts.map((context) => context.close()));
	},
	state: async ({ browse, byItself }, use) => {
		const page = await browse(byItself ? null : EVA, '/state', HIGH);
		await expect(page.locator('[data-row]')).not.toHaveCount(0);
		await use(page);
	},
	watch: async ({ browse, byItself }, use) => {
		const page = await browse(byItself ? null : EVA, '/operator', WRIST);
		await expect(page).toHaveTitle(/^Operator view · /); // until it is known who looks on, a page has no name
		await expect(page.getByRole('heading')).toBeVisible();
		await expect(page.getByTestId('not-live')).toBeHidden();
		await use(page);
	}
});

export { expect };
