/** The test function of all specs: with a station, an operator's page and a watch. */
import { test as base, expect, type Browser, type Page } from '@playwright/test';
import { join } from 'node:path';
import { Bench } from './bench.ts';
import { Station } from './station.ts';

interface Given {
	/** Name of the station to share with the other tests of that name; null for one of the test's own. */
	shared: string | null;
	/** Whether the station starts with devices and production (the default), or waits for the test to do so. */
	byItself: boolean;
	station: Station;
	/** The operator's page. */
	operate: Page;
	/** The watch page on a round watch of 192 dp. */
	watch: Page;
	/** What the browser found wrong on both pages: script errors, refused content, failed requests. */
	complaints: string[];
}

function listen(page: Page, complaints: string[]): void {
	page.on('console', (message) => {
		if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
	});
	page.on('pageerror', (error) => complaints.push(error.message));
}

async function openWatch(browser: Browser, url: string, colorScheme: 'light' | 'dark'): Promise<Page> {
	const context = await browser.newContext({
		baseURL: url,
		viewport: { width: 192, height: 192 },
		deviceScaleFactor: 2,
		hasTouch: true,
		colorScheme
	});
	return context.newPage();
}

/** Folder for the output of a station's processes. */
function logsOf(name: string): string {
	return join(import.meta.dirname, '../artefacts/logs', name.replace(/[^\w]+/g, '-'));
}

export const test = base.extend<Given, { bench: Bench }>({
	shared: ['at work', { option: true }],
	byItself: [true, { option: true }],
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
		async ({ bench, shared, byItself }, use, info) => {
			const project = info.project.name;
			if (shared !== null) {
				await use(await bench.kept(shared, { byItself, logs: logsOf(`${shared} ${project}`) }));
				return;
			}
			const station = await Station.start({ byItself, logs: logsOf(`${info.titlePath.join(' ')} ${project}`) });
			await use(station);
			await station.stop();
		},
		{ timeout: 90_000 }
	],
	operate: async ({ page, station, complaints }, use) => {
		listen(page, complaints);
		await page.goto(`${station.url}/`);
		await expect(page.getByTestId('live-age')).toContainText('live');
		await expect(page.getByTestId('not-live')).toBeHidden();
		await use(page);
	},
	watch: async ({ browser, station, colorScheme, complaints }, use) => {
		const page = await openWatch(browser, station.url, colorScheme === 'dark' ? 'dark' : 'light');
		listen(page, complaints);
		await page.goto('/watch');
		await expect(page.getByRole('heading')).toBeVisible();
		await expect(page.getByTestId('not-live')).toBeHidden();
		await use(page);
		await page.context().close();
	}
});

export { expect };
