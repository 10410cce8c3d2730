import { findings, outsideCircle, overflow, smallTargets } from '../../station/barriers.ts';
import { done, picture, restsOnPerson, takeControl } from '../../station/seen.ts';
import { EVA } from '../../station/station.ts';
import { DESK, expect, test, WRIST } from '../../station/test.ts';
import type { Page } from '@playwright/test';

const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true };

/** Counts from now on how often the device vibrates and how often a tone begins. */
async function listen(watch: Page): Promise<() => Promise<readonly [buzzes: number, tones: number]>> {
	const counted = await watch.evaluateHandle(() => {
		const counts = { buzzes: 0, tones: 0 };
		navigator.vibrate = () => ++counts.buzzes > 0;
		const start = OscillatorNode.prototype.start;
		OscillatorNode.prototype.start = function (...when): void {
			counts.tones++;
			start.apply(this, when);
		};
		return counts;
	});
	return async () => {
		const { buzzes, tones } = await counted.jsonValue();
		return [buzzes, tones];
	};
}

test('a problem told on the watch is an alarm until it is solved, and the next task is heard and felt @theme', async ({
	operate,
	watch
}) => {
	await restsOnPerson(operate, watch);
	const alarm = operate.locator('[data-alarm^="problem:"]');
	const problem = watch.locator('button[data-problem]');
	await problem.tap();
	await expect(watch.locator('button[data-wrong]')).toHaveCount(4);
	expect(await outsideCircle(watch)).toEqual([]);
	expect(await smallTargets(watch)).toEqual([]);
	expect(await findings(watch)).toEqual([]);
	await picture(watch, 'watch-wrong');
	await watch.locator('button[data-wrong="missing"]').tap();
	await expect(alarm).toHaveAttribute('data-state', 'unacknowledged');
	await expect(alarm).toContainText('a part is missing');
	await expect(watch.getByTestId('problem')).toBeVisible();
	// A small face has little room, and says which one all the same.
	expect(await watch.getByTestId('problem').evaluate((element: HTMLElement) => element.innerText)).toMatch(/Part missing$/);
	// The card of the alarm has told it: the task below refers to it.
	await expect(operate.getByTestId('problem-above')).toHaveText('Its problem is told above');
	await expect(operate.getByTestId('problem')).toHaveCount(0);
	expect(await outsideCircle(watch)).toEqual([]);
	expect(await findings(watch)).toEqual([]);
	await picture(watch, 'watch-problem');
	await problem.tap();
	await expect(watch.getByTestId('problem')).toHaveCount(0);
	await expect(alarm).toHaveAttribute('data-state', 'returned');
	await expect(alarm).toContainText('had a problem with');
	await expect(alarm).toContainText('Over since');
	await alarm.getByRole('button', { name: 'Acknowledge' }).click();
	await expect(alarm).toHaveCount(0);

	// What the station does is said with the task, and what a press would do.
	for (const [act, words] of [
		['Pause', 'Paused'],
		['Hold', 'Held: keep clear']
	] as const) {
		await operate.getByRole('button', { name: act, exact: true }).click();
		await expect(watch.getByTestId('standing')).toHaveText(words);
		await expect(watch.getByText('Nothing starts yet')).toBeVisible();
		await expect(watch.getByText('Moves next')).toHaveCount(0);
		// Nobody waits for it, and it says that nothing comes of it but a record.
		await expect(done(watch)).toHaveText('Record as done');
		await expect(done(watch)).toHaveCSS('border-style', 'dashed');
		expect(await smallTargets(watch)).toEqual([]);
		expect(await findings(watch)).toEqual([]);
		expect(await outsideCircle(watch)).toEqual([]);
		await picture(watch, `watch-${act.toLowerCase()}`);
	}
	await takeControl(operate);
	await operate.getByRole('button', { name: 'Continue', exact: true }).first().click();
	await expect(watch.getByTestId('standing')).toHaveCount(0);
	await expect(done(watch)).toHaveText('Done');

	// The wearer's own page on a phone, where text is larger.
	await watch.setViewportSize(PHONE.viewport);
	await watch.evaluate(() => (document.documentElement.style.fontSize = '200%'));
	expect(await overflow(watch)).toBe(0);
	expect(await smallTargets(watch)).toEqual([]);
	await picture(watch, 'watch-phone');

	const heard = await listen(watch);
	const before = await done(watch).getAttribute('data-task');
	await done(watch).tap();
	await expect(done(watch)).not.toHaveAttribute('data-task', before ?? '', { timeout: 60_000 });
	await expect.poll(heard).toEqual([1, 2]);
});

test('a rectangular watch uses its corners, and who wears it can say which screen it has', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const page = watch.locator('html');
	await expect(page).toHaveAttribute('data-face', 'round');
	await watch.getByRole('button', { name: 'For a square screen' }).tap();
	await expect(page).toHaveAttribute('data-face', 'square');
	await watch.reload();
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	await expect(page).toHaveAttribute('data-face', 'square');
	for (const height of [192, 228]) {
		await watch.setViewportSize({ width: 192, height });
		await watch.evaluate(() => scrollTo(0, 0));
		// What is pressed goes from edge to edge: above from the top, below to where the screen ends.
		const [above, below] = [await watch.locator('button[data-problem]').boundingBox(), await done(watch).boundingBox()];
		expect(above).toMatchObject({ x: 0, y: 0, width: 192 });
		expect(below).toMatchObject({ x: 0, width: 192 });
		expect((below?.y ?? 0) + (below?.height ?? 0)).toBeCloseTo(height, 0);
		expect(await overflow(watch)).toBe(0);
		expect(await smallTargets(watch)).toEqual([]);
		expect(await findings(watch)).toEqual([]);
		await picture(watch, `watch-square-${height}`);
	}
	await watch.getByRole('button', { name: 'For a round screen' }).tap();
	await watch.setViewportSize({ width: 192, height: 192 });
	await expect(page).toHaveAttribute('data-face', 'round');
	await watch.evaluate(() => scrollTo(0, 0));
	expect(await outsideCircle(watch)).toEqual([]);
	// One that is longer one way than the other is no round one: nobody has to say so.
	await watch.evaluate(() => localStorage.removeItem('watch-shape'));
	await watch.reload();
	await expect(page).toHaveAttribute('data-face', 'round');
	await watch.setViewportSize({ width: 192, height: 228 });
	await expect(page).toHaveAttribute('data-face', 'square');
});

test('the watch can be installed, opens without the server, and what it sends late completes no other task', async ({
	browse,
	operate
}) => {
	const watch = await browse(null, '/operator', WRIST);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	// A watch has a slow radio: all the page's scripts, as they are sent.
	const swedish = await browse(null, '/operator', { ...WRIST, locale: 'sv-SE' });
	await expect(done(swedish)).toHaveText('Klart', { timeout: 60_000 });
	await expect(swedish.getByRole('heading', { name: /^Sätt i / })).toBeVisible();
	for (const each of [watch, swedish]) {
		const sent = await each.evaluate(() =>
			(performance.getEntriesByType('resource') as PerformanceResourceTiming[])
				.filter(({ name }) => name.endsWith('.js'))
				.reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0)
		);
		expect(sent).toBeGreaterThan(10_000);
		expect(sent).toBeLessThan(60_000);
	}
	await swedish.close();

	const devtools = await watch.context().newCDPSession(watch);
	const { installabilityErrors } = await devtools.send('Page.getInstallabilityErrors');
	// A test's browser keeps nothing, as a private window, where nothing is installed.
	expect(installabilityErrors.map(({ errorId }) => errorId).filter((id) => id !== 'in-incognito')).toEqual([]);
	await watch.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));

	await watch.context().setOffline(true);
	await watch.reload();
	await expect(watch.getByRole('status')).toContainText('Not live');
	await watch.context().setOffline(false);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 30_000 });

	// What was sent hangs on the way; somebody else says that the task is done, and the next one comes.
	const task = (await done(watch).getAttribute('data-task')) ?? '';
	let release = (): void => undefined;
	const held = new Promise<void>((resolve) => (release = resolve));
	await watch.route('**/acknowledgement', async (route) => {
		await held;
		await route.continue();
	});
	await done(watch).tap();
	await operate.locator(`button[data-task="${task}"]`).click();
	await expect(operate.locator(`button[data-task="${task}"]`)).toHaveCount(0);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	const next = (await done(watch).getAttribute('data-task')) ?? '';
	expect(next).not.toBe(task);
	const late = watch.waitForResponse(/acknowledgement/);
	release();
	expect((await late).status()).toBe(409);
	await watch.waitForTimeout(500);
	await expect(done(watch)).toHaveAttribute('data-task', next);
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false');
});

/** An alarm as the station tells it where nothing starts before somebody has come. */
const ALARM = {
	kind: 'unsafe-state',
	subject: '',
	group: 'recovery',
	priority: 'high',
	state: 'unacknowledged',
	text: 'No torque at pair 4',
	consequence: 'Nothing starts.',
	action: 'Look at the bolts of pair 4.',
	messages: { text: { id: 'of-another-version' }, consequence: null, action: null, parts: [] },
	resources: [],
	topics: [],
	since: 1_700_000_000,
	ended: null,
	by: null,
	until: null,
	why: null,
	count: 1,
	parts: []
};

test('what is wrong takes the face while the station stands, is felt and heard, and gives way to the task on request @theme', async ({
	operate,
	watch
}) => {
	await restsOnPerson(operate, watch);
	let tell: (told: object) => void = () => undefined;
	await watch.routeWebSocket(/\/api\/v1\/stream/, (page) => {
		const server = page.connectToServer();
		let first = {};
		/** What the next message follows. */
		let [sequence, time] = [0, 0];
		server.onMessage((message) => {
			const told = JSON.parse(String(message)) as { kind: string; sequence?: number; view?: { time: number }; changed?: { time?: number } };
			if (told.view) first = told.view;
			sequence = told.sequence ?? sequence;
			time = told.view?.time ?? told.changed?.time ?? time;
			page.send(message);
		});
		tell = (changed) => page.send(JSON.stringify({ kind: 'snapshot', sequence, age: 0, view: { ...first, time, ...changed } }));
	});
	await watch.reload();
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	await watch.getByRole('main').click(); // browsers let a page be felt and heard once it was touched
	const heard = await listen(watch);

	// Of a device that fails beside the work the task stays, and the alarm is said over it.
	tell({ failing: ['Robot UR10'], named_alarm: 'a', alarms: { a: { ...ALARM, priority: 'medium', text: 'Robot UR10 stands still' } } });
	await expect(watch.getByTestId('standing')).toHaveText('Robot UR10 stands still');
	await expect(done(watch)).toBeVisible();
	await expect.poll(heard).toEqual([1, 4]);

	// It is read from its first words, however far the task was scrolled.
	await watch.evaluate(() => scrollTo(0, 45));
	expect(await watch.evaluate(() => scrollY)).toBeGreaterThan(20);
	tell({ standing: 'stopped', named_alarm: 'a', alarms: { a: ALARM } });
	await expect(watch.getByRole('heading', { name: 'No torque at pair 4' })).toBeVisible();
	expect(await watch.evaluate(() => scrollY)).toBe(0);
	await expect(done(watch)).toHaveCount(0);
	await expect.poll(heard).toEqual([2, 8]);
	expect(await outsideCircle(watch)).toEqual([]);
	expect(await smallTargets(watch)).toEqual([]);
	expect(await findings(watch)).toEqual([]);
	await picture(watch, 'watch-alarm');
	const seen = watch.waitForRequest(/alarms\/acknowledge/);
	await watch.getByRole('button', { name: 'Seen' }).tap();
	expect((await seen).postDataJSON()).toEqual({ alarm: 'a', since: ALARM.since });

	await watch.setViewportSize(PHONE.viewport);
	tell({ standing: 'stopped', named_alarm: 'a', alarms: { a: { ...ALARM, since: ALARM.since + 1 } } });
	await expect(watch.getByText('Look at the bolts of pair 4.')).toBeVisible();
	expect(await overflow(watch)).toBe(0);
	expect(await findings(watch)).toEqual([]);
	await picture(watch, 'watch-alarm-phone');
	await watch.getByRole('button', { name: 'To my task' }).tap();
	await expect(done(watch)).toHaveText('Record as done');
	await expect(watch.getByTestId('standing')).toHaveText('No torque at pair 4');
});

test.describe('whose browser reads Swedish', () => {
	test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

	test('reads the watch and the sign-in so, and the language that is chosen is kept', async ({ browse }) => {
		const watch = await browse(null, '/operator', { ...WRIST, locale: 'sv-SE' });
		await expect(watch.getByRole('heading', { name: 'Para ihop klockan' })).toBeVisible();
		expect(await outsideCircle(watch)).toEqual([]);
		await picture(watch, 'watch-swedish');

		const eva = await browse(null, '/sign-in', { ...DESK, locale: 'sv-SE' });
		await expect(eva.getByRole('heading', { name: 'Logga in' })).toBeVisible();
		await expect(eva.locator('html')).toHaveAttribute('lang', 'sv');
		await eva.getByLabel('Namn').fill(EVA.name);
		await eva.getByLabel('Lösenord', { exact: true }).fill(EVA.password);
		await eva.getByRole('button', { name: 'Logga in' }).click();
		await expect(eva.getByTestId('who')).toContainText('operatör');
		// What the model calls its parts is told in the language of the page, and at once in another one.
		const operation = eva.locator('[data-operation="new_engine"]');
		const resource = eva.getByTestId('mimic').locator('[data-symbol="operator"]');
		await expect(operation).toContainText('Ny motor');
		await expect(resource).toHaveAccessibleName(/^Operatören/);
		await eva.getByTestId('who').click();
		await eva.getByRole('button', { name: 'English' }).click();
		await expect(operation).toContainText('New engine');
		await expect(resource).toHaveAccessibleName(/^Operator/);
		await eva.getByRole('button', { name: 'Svenska' }).click();
		await expect(operation).toContainText('Ny motor');
		await eva.keyboard.press('Escape');
		await eva.goto('/account');
		await expect(eva.getByRole('heading', { name: 'Roll' })).toBeVisible();
		await eva.getByTestId('who').click();
		await eva.getByRole('button', { name: 'English' }).click();
		await expect(eva.getByRole('heading', { name: 'Role' })).toBeVisible();
		await eva.reload();
		await expect(eva.getByRole('heading', { name: 'Role' })).toBeVisible();
		await expect(eva.locator('html')).toHaveAttribute('lang', 'en');
	});
});
