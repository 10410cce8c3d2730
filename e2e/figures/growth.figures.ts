/**
 * What the pages take as a station grows: the truck engine station once, twice and four times in one model, at work.
 *
 * `SIZES` names other sizes. Figures for `docs/performance.md`, which also says what the models are.
 */
import type { Page } from '@playwright/test';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { EXECUTABLE, Station } from '../station/station.ts';
import { expect, test } from '../station/test.ts';
import { framesOf, heapOf } from './frames.ts';
import { opened, prepare } from './moments.ts';

const ROOT = resolve(import.meta.dirname, '../..');
const PYTHON = join(ROOT, 'backend/.venv/bin/python');
const GENERATOR = join(ROOT, 'backend/benchmarks/stations/several.py');
const SIZES = (process.env['SIZES'] ?? '1 2 4').split(' ').map(Number);
const LIVE = { selector: '[data-testid="strip"][data-live="true"]', text: '' };
/** What shows that a page has what it is for. */
const PAGES = [
	['/', LIVE],
	['/state', LIVE],
	['/model', { selector: '[role="treeitem"]', text: 'agv_1' }],
	['/model?view=graph', { selector: '[data-layer]', text: 'robot_1' }]
] as const;
const VISITS = 5;
const SECONDS = 20;
/** Milliseconds in which all that a page loads later is there. */
const SETTLED = 5000;
/** Seconds for the safe states of a large one, which the station then finds. */
const DEADLINE = 900;

async function figures(page: Page): Promise<string> {
	const session = await page.context().newCDPSession(page);
	await session.send('Performance.enable');
	const busy = async (): Promise<number> => {
		const { metrics } = await session.send('Performance.getMetrics');
		return metrics.find(({ name }) => name === 'TaskDuration')?.value ?? NaN;
	};
	await page.waitForTimeout(SETTLED);
	const before = await busy();
	const { mean, worst } = await framesOf(page, SECONDS);
	const share = (100 * ((await busy()) - before)) / SECONDS;
	return `${mean.toFixed(0)} frames a second, ${worst} in the worst, ${share.toFixed(0)} % of a core, ${(await heapOf(session)).toFixed(1)} MB`;
}

for (const size of SIZES)
	test(`the pages of ${size} × the truck engine station`, async ({ browser }) => {
		const folder = mkdtempSync(join(tmpdir(), 'growth-'));
		const model = join(folder, 'model');
		execFileSync(PYTHON, [GENERATOR, model, String(size)]);
		spawnSync(EXECUTABLE, ['plan', model, '--contract', 'fast', '--deadline', String(DEADLINE)]);
		const station = await Station.start({
			byItself: true,
			devices: false,
			people: [],
			model,
			logs: join(ROOT, 'e2e/artefacts/logs/figures')
		});
		try {
			for (const [address, sought] of PAGES) {
				const took: number[] = [];
				for (let visit = 0; visit < VISITS; visit += 1) {
					const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
					const page = await context.newPage();
					await prepare(page);
					took.push(await opened(page, `${station.url}${address}`, sought));
					if (visit === VISITS - 1) {
						await expect(page.locator('main')).toBeVisible();
						const seconds = ([...took].sort((a, b) => a - b)[Math.floor(VISITS / 2)] ?? NaN) / 1000;
						console.log(`${size} × ${address}: there after ${seconds.toFixed(2)} s, ${await figures(page)}`);
					}
					await context.close();
				}
			}
		} finally {
			await station.stop();
			rmSync(folder, { recursive: true });
		}
	});
