/** The walls of two stations in one page: each is heard by itself, and one that is gone says so and comes back. */
import { join } from 'node:path';
import { ADA, EVA, freePort, Station } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test('walls stand side by side, and one that is gone says so until it is back', async ({ browser }) => {
	const ports = [await freePort(), await freePort()] as const;
	const start = (own: number, other: number): Promise<Station> =>
		Station.start({
			byItself: false,
			devices: false,
			people: [ADA, EVA],
			port: own,
			environment: { SEQUENCE_PLANNER_WALL_BESIDE: `http://127.0.0.1:${other}/` },
			logs: join(import.meta.dirname, `../../artefacts/logs/walls-${own}`)
		});
	const [here, there] = await Promise.all([start(...ports), start(ports[1], ports[0])]);
	try {
		const context = await browser.newContext({ viewport: { width: 1920, height: 1080 } });
		await context.addCookies([{ ...(await here.signIn(EVA)), url: here.url }]);
		const page = await context.newPage();
		await page.goto(`${here.url}/wall`);
		await page.getByRole('link', { name: 'Side by side' }).click();
		const wall = (station: Station) => page.frameLocator(`iframe[src^="${station.url}/"]`);
		await expect(wall(here).locator('[data-glance="mode"]')).toBeVisible();
		await expect(wall(here).getByRole('button', { name: /Hold|Pause|control/ })).toHaveCount(0); // the page around it has these
		await expect(page.getByRole('button', { name: 'Hold', exact: true })).toBeInViewport({ ratio: 1 });
		const drawn = wall(here).getByRole('button', { name: /^Cover plate/ });
		for (const [width, height] of [[1920, 1080], [1440, 900]] as const) {
			await page.setViewportSize({ width, height });
			const figure = await wall(here).locator('dt').first().boundingBox();
			const picture = await drawn.boundingBox();
			expect((picture?.y ?? NaN) + (picture?.height ?? NaN), `above the figures on ${width}`).toBeLessThanOrEqual(figure?.y ?? NaN);
		}

		// Each lets in whom it knows.
		const name = wall(there).getByLabel('Name');
		await name.fill(EVA.name);
		await wall(there).getByLabel('Password', { exact: true }).fill(EVA.password);
		await wall(there).getByRole('button', { name: 'Sign in' }).click();
		await expect(wall(there).locator('[data-glance="mode"]')).toBeVisible();

		const gone = page.getByText(`Nothing heard from 127.0.0.1:${there.port}`);
		await expect(gone).toBeHidden();
		there.server.signalTree('SIGSTOP');
		try {
			await expect(wall(there).getByTestId('wall-stale')).toBeVisible();
		} finally {
			there.server.signalTree('SIGCONT');
		}
		await expect(wall(there).getByTestId('wall-stale')).toBeHidden();
		await page.frames().find((frame) => frame.url().startsWith(there.url))?.goto('about:blank');
		await expect(gone).toBeInViewport({ ratio: 1 });
		await expect(gone).toBeHidden({ timeout: 30_000 });
		await expect(wall(there).locator('[data-glance="mode"]')).toBeVisible();

		// No other page of a station stands in one, and no page of another in this one.
		const stolen = await page.evaluate(async (url) => (await fetch(url)).headers.get('content-security-policy'), `${here.url}/state`);
		expect(stolen).toContain("frame-ancestors 'none'");
		await context.close();
	} finally {
		await Promise.all([here.stop(), there.stop()]);
	}
});
