/**
 * How smoothly the graph of a station of 500 boxes is moved by the pointer, while messages pass all its pipelines ten times a
 * second: close by, and with all of it in sight. The report goes to `docs/campaigns/pipelines.md`.
 */
import type { CDPSession, Page } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { EVA, Station } from '../station/station.ts';
import { expect, test } from '../station/test.ts';
import { framesOf } from './frames.ts';

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
		const [x, y] = [box.x + box.width / 2, box.y + box.height * 0.85];
		await page.mouse.move(x, y);
		await page.mouse.down();
		for (let step = 1; step <= 40 && Date.now() < end; step++)
			await page.mouse.move(x + (stroke % 2 ? 7 : -7) * step, y - (stroke % 4 < 2 ? 6 : -6) * step);
		await page.mouse.up();
	}
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
	const rows: string[] = [];
	try {
		const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
		await context.addCookies([{ ...(await station.signIn(EVA)), url: station.url }]);
		const page = await context.newPage();
		const session = await context.newCDPSession(page);
		await session.send('Performance.enable', { timeDomain: 'threadTicks' });
		await page.goto(`${station.url}/pipelines`);
		const drawn = performance.now();
		await expect(page.locator('.svelte-flow__node').first()).toBeVisible({ timeout: 120_000 });
		rows.push(`The graph is there ${((performance.now() - drawn) / 1000).toFixed(1)} s after the page.`, '');
		rows.push('| in sight | boxes in the document | frames a second | in the worst second | processor time a frame |', '|---|---|---|---|---|');
		// The check of the draft and what is read first are over.
		await expect(page.locator('[data-check="done"]')).toBeVisible({ timeout: 120_000 });
		for (const [name, prepare] of [
			['a part, as it can be read', async () => undefined],
			['all of it', async () => page.getByRole('button', { name: 'Show all of it' }).click()]
		] as const) {
			await prepare();
			await page.waitForTimeout(3000);
			const boxes = await page.locator('.svelte-flow__node').count();
			const before = await spentOn(session);
			const [frames] = await Promise.all([framesOf(page, SECONDS), pan(page, SECONDS * 1000)]);
			const spent = ((await spentOn(session)) - before) / (frames.mean * SECONDS);
			rows.push(`| ${name} | ${boxes} | ${frames.mean.toFixed(1)} | ${frames.worst} | ${(spent * 1000).toFixed(1)} ms |`);
			await page.screenshot({ path: join(ROOT, `e2e/artefacts/figures-${boxes}.png`) });
		}
	} finally {
		await station.stop();
		rmSync(folder, { recursive: true });
	}
	const commit = execFileSync('git', ['describe', '--always', '--dirty'], { cwd: ROOT, encoding: 'utf8' }).trim();
	const text = [
		'# The graph of 500 boxes in Chromium',
		'',
		`Made by \`make figures\` at commit ${commit} on ${cpus().length} cores, beside all processes of a station of 504 boxes whose messages pass ten times a second; drawn to and fro by the pointer for ${SECONDS} seconds.`,
		'',
		...rows,
		''
	].join('\n');
	writeFileSync(REPORT, text);
	console.log(text);
});
