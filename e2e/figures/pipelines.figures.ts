/**
 * How smoothly the graph of a station of 500 boxes is moved by the pointer, while messages pass all its pipelines ten times a
 * second, and all variables have another value with each of them: close by, as far away as values are drawn, and with
 * all of it in sight. How many values changed is counted in the page itself. The report goes to `docs/campaigns/pipelines.md`.
 */
import type { CDPSession, Page } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, loadavg, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { EVA, Station } from '../station/station.ts';
import { expect, test } from '../station/test.ts';
import { changesOf, framesOf } from './frames.ts';

const ROOT = resolve(import.meta.dirname, '../..');
const PYTHON = join(ROOT, 'backend/.venv/bin/python');
const MADE = join(import.meta.dirname, 'pipelines_station.py');
const SECONDS = 10;
const REPORT = join(ROOT, 'docs/campaigns/pipelines.md');

/** Draws the graph to and fro for so many milliseconds. */
async function pan(page: Page, milliseconds: number): Promise<void> {
	const box = await page.locator('.svelte-flow').boundingBox();
	if (!box) throw new Error('there is no graph');
	const end = Date.now() + milliseconds;
	for (let stroke = 0; Date.now() < end; stroke++) {
		// Where there is neither a box nor a wire: who begins on one draws that, and not the graph.
		const { x, y } = await page.evaluate(({ left, top, width, height }) => {
			for (let n = 0; n < 400; n++) {
				const [x, y] = [left + width * (0.3 + (0.4 * (n % 20)) / 20), top + height * (0.3 + (0.4 * Math.floor(n / 20)) / 20)];
				if (document.elementFromPoint(x, y)?.classList.contains('svelte-flow__pane')) return { x, y };
			}
			throw new Error('there is no room between the boxes');
		}, { left: box.x, top: box.y, width: box.width, height: box.height });
		await page.mouse.move(x, y);
		await page.mouse.down();
		for (let step = 1; step <= 40 && Date.now() < end; step++)
			await page.mouse.move(x + (stroke % 2 ? 7 : -7) * step, y - (stroke % 4 < 2 ? 6 : -6) * step);
		await page.mouse.up();
	}
}

/** How often the station told the page that a variable is another one, by its name. */
function toldTo(page: Page): Map<string, number> {
	const told = new Map<string, number>();
	page.on('websocket', (socket) => {
		socket.on('framereceived', ({ payload }) => {
			const message = JSON.parse(String(payload)) as { kind: string; changed?: { variables?: Record<string, unknown> } };
			if (message.kind === 'delta') for (const name of Object.keys(message.changed?.variables ?? {})) told.set(name, (told.get(name) ?? 0) + 1);
		});
	});
	return told;
}

/** Seconds of processor time that the page's main thread has worked: they do not depend on what else the machine does. */
async function spentOn(session: CDPSession): Promise<number> {
	const { metrics } = await session.send('Performance.getMetrics');
	return metrics.find(({ name }) => name === 'TaskDuration')?.value ?? NaN;
}

test('a graph of 500 boxes is moved', async ({ browser }) => {
	const folder = mkdtempSync(join(tmpdir(), 'pipelines-'));
	execFileSync(PYTHON, [MADE, 'model', join(folder, 'model')]);
	const station = await Station.start({
		byItself: false,
		devices: false,
		people: [EVA],
		model: join(folder, 'model'),
		beside: [PYTHON, [MADE, 'speak', join(folder, 'model')]],
		logs: join(ROOT, 'e2e/artefacts/logs/figures')
	});
	const load = loadavg()[0] ?? NaN;
	const rows: string[] = [];
	try {
		const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
		await context.addCookies([{ ...(await station.signIn(EVA)), url: station.url }]);
		const page = await context.newPage();
		const session = await context.newCDPSession(page);
		const told = toldTo(page);
		await session.send('Performance.enable', { timeDomain: 'threadTicks' });
		await page.goto(`${station.url}/pipelines`);
		const drawn = performance.now();
		await expect(page.locator('.svelte-flow__node').first()).toBeVisible({ timeout: 120_000 });
		rows.push(`The graph is there ${((performance.now() - drawn) / 1000).toFixed(1)} s after the page.`, '');
		rows.push(
			'| in sight | boxes in the document | variables told to the page that changed | each so often a second | of them drawn all the while | frames a second | in the worst second | processor time a frame |',
			'|---|---|---|---|---|---|---|---|'
		);
		// The check of the draft and what is read first are over.
		await expect(page.getByTestId('check')).toHaveAttribute('data-verdict', /./, { timeout: 120_000 });
		/** From all of it to where the values come into sight. */
		const nearer = async (): Promise<void> => {
			await page.getByRole('button', { name: 'Show all of it' }).click();
			await page.waitForTimeout(1000);
			const far = page.locator('.graph.far');
			for (let press = 0; press < 20 && (await far.count()) > 0; press++) {
				await page.getByRole('button', { name: 'Enlarge' }).click();
				await page.waitForTimeout(700);
			}
			await expect(far).toHaveCount(0);
		};
		for (const [name, prepare] of [
			['a part, as it can be read', async () => undefined],
			['all of it', async () => page.getByRole('button', { name: 'Show all of it' }).click()],
			['as much as values are drawn of', nearer]
		] as const) {
			await prepare();
			await page.waitForTimeout(3000);
			const boxes = await page.locator('.svelte-flow__node').count();
			const before = await spentOn(session);
			told.clear();
			const [frames, changing] = await Promise.all([framesOf(page, SECONDS), changesOf(page, '.box.variable .value', SECONDS), pan(page, SECONDS * 1000)]);
			const often = [...told.values()].reduce((sum, each) => sum + each, 0) / Math.max(1, told.size);
			const spent = ((await spentOn(session)) - before) / (frames.mean * SECONDS);
			rows.push(`| ${name} | ${boxes} | ${told.size} | ${(often / SECONDS).toFixed(1)} | ${changing.values} | ${frames.mean.toFixed(1)} | ${frames.worst} | ${(spent * 1000).toFixed(1)} ms |`);
			await page.screenshot({ path: join(ROOT, `e2e/artefacts/figures-${name.replaceAll(/\W+/g, '-')}.png`) });
		}
	} finally {
		await station.stop();
		rmSync(folder, { recursive: true });
	}
	const commit = execFileSync('git', ['describe', '--always', '--dirty'], { cwd: ROOT, encoding: 'utf8' }).trim();
	const text = [
		'# The graph of 500 boxes in Chromium',
		'',
		`Made by \`make figures\` at commit ${commit} on ${cpus().length} cores, beside all processes of a station of 504 boxes whose messages pass ten times a second, and of which 252 variables are others with each; drawn to and fro by the pointer for ${SECONDS} seconds. The load of the machine was ${load.toFixed(1)} before. From further away than values can be read none is drawn. Where the load is above the number of cores the frames are those that others left to it; then the processor time of the page’s own thread says more, of which 18 ms a frame would leave 55 frames a second.`,
		'',
		...rows,
		''
	].join('\n');
	writeFileSync(REPORT, text);
	console.log(text);
});
