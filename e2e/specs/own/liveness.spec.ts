import { findings } from '../../station/barriers.ts';
import { acknowledge, done, picture, restsOnPerson, takeControl, tightenings, variable } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('a view that is no longer live says so within 2 s, on either page @theme', async ({ operate, state, watch, station }) => {
	await restsOnPerson(operate, watch);
	await expect(variable(state, 'robot.pose')).not.toContainText('old');

	// The whole station stands still, as when its machine hangs: connections stay open and nothing comes.
	station.server.signalTree('SIGSTOP');
	try {
		await Promise.all([
			expect(operate.getByTestId('not-live')).toBeVisible({ timeout: 2000 }),
			expect(watch.getByTestId('not-live')).toBeVisible({ timeout: 2000 })
		]);
		await expect(variable(state, 'robot.pose')).toContainText('old');
		await expect(operate.getByTestId('stale')).toContainText('Not live');
		await picture(operate, 'operate-old');
		await picture(watch, 'watch-old');
		expect(await findings(operate)).toEqual([]);
		expect(await findings(watch)).toEqual([]);

		// Nobody acknowledges what may no longer be so.
		await expect(done(watch)).toHaveAttribute('aria-disabled', 'true');
		const requests: string[] = [];
		watch.on('request', (request) => requests.push(request.url()));
		await done(watch).tap({ force: true });
		expect(requests.filter((url) => url.includes('acknowledgement'))).toEqual([]);
	} finally {
		station.server.signalTree('SIGCONT');
	}
	await expect(operate.getByTestId('not-live')).toBeHidden();
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false');
});

/** As a station tells it that does not know whether it is safe. */
const REASON = 'Safety unknown: nothing heard from Robot UR10.';
const UNSURE = {
	violated: [],
	threatened: [],
	differences: [],
	awaits: ['/robot/state'],
	ticks: null,
	steps: [],
	breaks: [],
	reason: REASON,
	reason_message: { id: 'unsafe.unheard', arguments: { devices: ['Robot UR10'] } }
};

test('who cannot tell whether the station is safe says whom it does not hear, on each page that speaks of it', async ({ operate, station }) => {
	await operate.routeWebSocket(/\/api\/v1\/stream/, (page) => {
		const server = page.connectToServer();
		server.onMessage((message) => {
			const told = JSON.parse(String(message)) as { kind: string; view?: object };
			page.send(told.kind === 'snapshot' ? JSON.stringify({ ...told, view: { ...told.view, way_back: UNSURE } }) : message);
		});
	});
	for (const path of ['/', '/restart', '/wall']) {
		await operate.goto(`${station.url}${path}`);
		// As a heading it has no full stop.
		await expect(operate.getByText(REASON.replace(/\.$/, '')).first(), path).toBeVisible();
	}
});

test.describe('when a part of the station dies', () => {
	test.use({ shared: null });

	test('a controller that is killed is said to be lost, comes back, and waits for a person @long', async ({
		operate,
		state,
		watch,
		station
	}) => {
		await restsOnPerson(operate, watch);
		const pair = await acknowledge(watch);
		await expect(variable(state, `bolts[${pair}]`)).toHaveAttribute('data-value', 'tightened', { timeout: 60_000 });
		await restsOnPerson(operate, watch);

		// Silent first, so that what is said of it does not depend on how soon it is started again.
		station.server.signalPart('controller', 'SIGSTOP');
		await Promise.all([
			expect(operate.getByTestId('not-live')).toBeVisible({ timeout: 2000 }),
			expect(watch.getByTestId('not-live')).toBeVisible({ timeout: 2000 })
		]);
		await expect(operate.getByTestId('not-live')).toContainText('does not hear the controller');
		await expect(variable(state, `bolts[${pair}]`)).toContainText('old');
		await expect(done(watch)).toHaveAttribute('aria-disabled', 'true');
		station.server.killPart('controller');

		// What the new one says replaces all that the old one said: no value of before is left among those of now.
		await expect(operate.getByTestId('not-live')).toBeHidden({ timeout: 30_000 });
		await expect(operate.getByTestId('mode')).toHaveAttribute('data-production', 'waiting', { timeout: 30_000 });
		await expect(variable(state, 'robot.pose')).not.toHaveAttribute('data-value', 'unknown');
		await expect(state.getByText('old', { exact: true })).toHaveCount(0);
		await expect(operate.getByText(/^as it was at/)).toHaveCount(0);
		// Some topics are heard later than others, so the values are asked for again until page and station agree.
		await expect(async () => {
			for (const [name, value] of await station.values())
				await expect(variable(state, name)).toHaveAttribute('data-value', value, { timeout: 500 });
		}).toPass({ timeout: 15_000 });
		await expect(done(watch)).toHaveCount(0);
		await expect(operate.locator('[data-step]')).toHaveCount(0);

		// What was asked for before would be asked for again: a person decides whether it shall be.
		await takeControl(operate);
		await operate.getByRole('button', { name: 'Start production' }).click();
		await expect(operate.getByRole('alert').filter({ hasText: 'requested_pair' })).toBeVisible();
		await operate.getByTestId('restart-notice').getByRole('link', { name: 'Decide on the outputs' }).click();
		await operate.getByRole('button', { name: 'Decide', exact: true }).click();
		const dialog = operate.getByRole('dialog');
		await dialog.getByRole('radio', { name: /bolt pair/ }).check();
		await dialog.getByLabel('Reason').fill('The person is still at it');
		await picture(operate, 'restart-undecided');
		expect(await findings(operate)).toEqual([]);
		await dialog.getByRole('button', { name: 'Decide' }).click();
		await expect(operate.getByTestId('undecided')).toBeHidden();
		await operate.getByRole('link', { name: 'Operate' }).click();
		// Its alarm is over, and stays until somebody has seen it.
		const alarm = operate.locator('[data-alarm]').filter({ hasText: 'requested_pair' });
		await expect(alarm).toHaveAttribute('data-state', 'returned');
		await alarm.getByRole('button', { name: 'Acknowledge' }).click();
		await expect(alarm).toHaveCount(0);
		await operate.getByRole('button', { name: 'Start production' }).click();
		// It was started before, so it is no step of a plan of the new controller's.
		await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
		await acknowledge(watch);
		await expect.poll(() => tightenings(operate), { timeout: 60_000 }).toBe(1);
	});

	test('a server that is gone is said to be gone', async ({ operate, watch, station }) => {
		const safety = 'use the safety devices of the station';
		// What it is made of is here before the server is gone.
		await operate.getByRole('link', { name: 'Orders', exact: true }).click();
		await expect(operate.getByRole('heading', { name: 'Orders', exact: true })).toBeVisible();
		await operate.getByRole('link', { name: 'Operate', exact: true }).click();
		await expect(operate.getByRole('region', { name: 'Plan' })).toBeVisible();
		station.server.signalTree('SIGSTOP');
		await expect(operate.getByTestId('not-live')).toContainText(safety, { timeout: 2000 });
		const hold = operate.getByTestId('stops').getByRole('button').last();
		await hold.click();
		await expect(hold, 'it is said at once that it is on its way').toHaveText('Sending', { timeout: 500 });
		await expect(operate.getByTestId('not-live').getByRole('alert')).toHaveText('Hold was not answered: nobody knows whether it has arrived.', { timeout: 15_000 });
		await expect(operate.getByTestId('not-live')).toContainText(safety);
		await expect(hold).toHaveText('Hold');
		await station.server.kill();
		await Promise.all([
			expect(operate.getByTestId('not-live')).toContainText('connection to the server is lost', { timeout: 2000 }),
			expect(watch.getByTestId('not-live')).toBeVisible({ timeout: 2000 })
		]);
		await hold.click();
		await expect(operate.getByTestId('not-live').getByRole('alert'), 'in place of what was said before').toHaveText('Hold was not sent.', { timeout: 15_000 });
		await operate.getByTestId('not-live').getByRole('button', { name: 'Try now' }).click();
		await operate.getByRole('link', { name: 'Orders', exact: true }).click();
		await expect(operate.getByRole('heading', { name: 'Orders', exact: true })).toBeVisible();
		await expect(operate.getByRole('main').getByText(/^as it was at/)).toBeVisible();
	});
});
