/**
 * What the engineer's page figures are with a large model, 200 resources with 1 000 abilities: how soon the page is there,
 * how it keeps up with typing, and how soon it says what is wrong.
 *
 * `ROUNDS` is how often each is looked at (7 unless it says otherwise). The report goes to `docs/campaigns/editing.md`.
 */
import type { Browser, BrowserContext, Page } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, loadavg, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { ERIK, Station } from '../station/station.ts';
import { expect, test } from '../station/test.ts';
import { after, keysOf, opened, prepare, type Sought } from './moments.ts';

const ROOT = resolve(import.meta.dirname, '../..');
const PYTHON = join(ROOT, 'backend/.venv/bin/python');
const GENERATOR = join(ROOT, 'backend/benchmarks/stations/large.py');
const REPORT = join(ROOT, 'docs/campaigns/editing.md');
const ROUNDS = Number(process.env['ROUNDS'] ?? '7');
/** Milliseconds between two keys of somebody who types fast. */
const PACE = 70;
/** Milliseconds until a browser has begun, and the server has signed somebody in. */
const SETTLED = 1000;

const MACHINE = 'resources/machine_100.yaml';
/** What a person who opens the page sees of the tree, and can use. */
const TREE: Sought = { selector: '[role="treeitem"]', text: 'machine_1' };
const ability = (step: number): string => [MACHINE, 'abilities', `step_${step}`].join('#');
const GUARD = 'automatic and machine_99.held and place == ';
const WRONG = { selector: '.cm-lintRange-error' };
const PROBLEM = { selector: 'li.error' };

const rows: string[] = [];

function note(what: string, milliseconds: readonly number[]): void {
	const [ordered, all] = [[...milliseconds].sort((a, b) => a - b), milliseconds.length];
	const at = (share: number): string => (ordered[Math.min(all - 1, Math.floor(all * share))] ?? NaN).toFixed(0);
	const row = `| ${what} | ${at(0.5)} ms | ${at(1)} ms | ${all} |`;
	rows.push(row);
	console.log(row);
}

/** A browser that has seen nothing of the station. */
async function fresh(browser: Browser, station: Station): Promise<{ context: BrowserContext; page: Page }> {
	const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
	await context.addCookies([{ ...(await station.signIn(ERIK)), url: station.url }]);
	const page = await context.newPage();
	await prepare(page);
	await page.waitForTimeout(SETTLED);
	return { context, page };
}

async function rounds(count: number, round: (number: number) => Promise<number>): Promise<number[]> {
	const found: number[] = [];
	for (let number = 0; number < count; number += 1) found.push(await round(number));
	return found;
}

/** The check of the draft has ended. */
const checked = (page: Page): Promise<void> =>
	expect(page.getByTestId('check')).toHaveAttribute('data-verdict', /./, { timeout: 120_000 });

async function typed(page: Page, text: string): Promise<void> {
	await page.keyboard.press('Control+a');
	await page.keyboard.type(text, { delay: PACE });
}

test('the page of a large model', async ({ browser }) => {
	const folder = mkdtempSync(join(tmpdir(), 'large-'));
	execFileSync(PYTHON, [GENERATOR, join(folder, 'large')]);
	const began = loadavg()[0] ?? NaN;
	const station = await Station.start({
		byItself: false,
		devices: false,
		people: [ERIK],
		model: join(folder, 'large'),
		logs: join(ROOT, 'e2e/artefacts/logs/figures')
	});
	try {
		await openings(browser, station);
		const { page } = await fresh(browser, station);
		await parts(page, station);
		await writing(page);
		await names(page, station);
	} finally {
		await station.stop();
		rmSync(folder, { recursive: true });
		report(began);
	}
});

async function openings(browser: Browser, station: Station): Promise<void> {
	const { context, page } = await fresh(browser, station);
	note('the address of Model, the first time since the server was started', [await opened(page, `${station.url}/model`, TREE)]);
	await checked(page);
	note(
		'again in the same browser',
		await rounds(ROUNDS, () => opened(page, `${station.url}/model`, TREE))
	);
	await context.close();
	note(
		'in a browser that has seen nothing of it',
		await rounds(ROUNDS, async () => {
			const other = await fresh(browser, station);
			const took = await opened(other.page, `${station.url}/model`, TREE);
			await other.context.close();
			return took;
		})
	);
}

/** Parts are opened in the tree, each with its form and the file. */
async function parts(page: Page, station: Station): Promise<void> {
	const entry = new URLSearchParams({ entry: ability(0) });
	const field: Sought = { selector: '[data-field="Enabled"] .cm-content, .cm-content[aria-label="Enabled"]', text: 'automatic' };
	note('the address of an ability, with its form and its file', [await opened(page, `${station.url}/model?${entry}`, field)]);
	await checked(page);
	const took = await rounds(ROUNDS, (number) => {
		const step = 1 + (number % 4);
		return after(page, { selector: 'h2 .name', text: `step_${step}` }, () =>
			page.locator(`[role="treeitem"][data-id="${ability(step)}"]`).click()
		);
	});
	note('an ability is chosen in the tree, until its form is there', took);
}

async function writing(page: Page): Promise<void> {
	const guard = page.getByRole('textbox', { name: 'Enabled', exact: true }).and(page.locator('.cm-content'));
	const error = page.locator('.cm-lintRange-error');
	const right = `${GUARD}p1`;
	const correct = async (): Promise<void> => {
		await guard.click();
		await page.keyboard.press('Control+a');
		await page.keyboard.insertText(right);
		await page.keyboard.press('Escape');
		await expect(error).toHaveCount(0);
		await page.keyboard.press('Tab');
		await expect(page.locator(PROBLEM.selector)).toHaveCount(0);
	};
	await correct();

	await guard.click();
	const texts = [`${GUARD}p1`, `not ${GUARD}p0`, `${GUARD}p2 and not (machine_98.held and machine_97.place == p1)`];
	const keys = texts.reduce((sum, text) => sum + text.length, 0);
	const slow = await keysOf(page, async () => {
		for (const text of texts) await typed(page, text);
	});
	// What the browser does not tell of was faster than it tells.
	note('a key while a guard is typed, to the next frame', [...slow, ...Array<number>(Math.max(0, keys - slow.length)).fill(16)]);
	await correct();

	const underlined = await rounds(ROUNDS, async () => {
		await correct();
		await guard.click();
		await page.keyboard.press('Control+a');
		return after(page, WRONG, () => page.keyboard.type(`${GUARD}p9`, { delay: PACE }));
	});
	note('a name that is none is underlined, after the last key', underlined);

	const told = await rounds(ROUNDS, async () => {
		await correct();
		await guard.click();
		await page.keyboard.press('Control+a');
		await page.keyboard.insertText(`${GUARD}p9`);
		return after(page, PROBLEM, () => page.keyboard.press('Enter'));
	});
	note('the same stands among the problems of the whole model, after the key that ends the entry', told);
	await correct();
}

/** A variable that every ability reads gets another name; then that is taken back. */
async function names(page: Page, station: Station): Promise<void> {
	const entry = (name: string): string => ['station.yaml', 'estimated', name].join('#');
	await page.goto(`${station.url}/model?${new URLSearchParams({ entry: entry('automatic') })}`);
	const heading: Sought = { selector: 'h2 .name', text: 'hands_free' };
	const [listed, named, back]: [number[], number[], number[]] = [[], [], []];
	for (let round = 0; round < ROUNDS; round += 1) {
		const rename = page.getByRole('button', { name: 'Rename…' });
		listed.push(await after(page, { selector: 'dialog li', text: 'machine_0' }, () => rename.click()));
		await page.getByRole('dialog').getByRole('textbox').fill('hands_free');
		named.push(await after(page, heading, () => page.keyboard.press('Enter')));
		await page.locator('h1').click();
		const gone: Sought = { selector: '[role="treeitem"]', text: 'hands_free', isThere: false };
		back.push(await after(page, gone, () => page.keyboard.press('Control+z')));
		await page.locator(`[role="treeitem"][data-id="${entry('automatic')}"]`).click();
	}
	note('where a variable that all abilities read is named', listed);
	note('that variable has another name, wherever it is named', named);
	note('that is taken back', back);
}

function report(began: number): void {
	const commit = execFileSync('git', ['describe', '--always', '--dirty'], { cwd: ROOT, encoding: 'utf8' }).trim();
	const loads = [began, loadavg()[0] ?? NaN].map((each) => each.toFixed(1)).join(' before and ');
	const text = [
		'# A large model in Chromium',
		'',
		`200 resources with 1 000 abilities (\`backend/benchmarks/stations/large.py\`), at commit ${commit} on ${cpus().length} cores, beside all`,
		`processes of the station; the load of the machine was ${loads} after. Made by \`make figures\`, or alone by`,
		'`cd e2e && npx playwright test --config figures/figures.config.ts large.figures`. Times are by the clock of the page, to the frame after the one that',
		'shows it; a key by Event Timing, in steps of 8 ms, 16 at least.',
		'',
		'| what | median | at most | looks |',
		'|---|---|---|---|',
		...rows,
		''
	].join('\n');
	writeFileSync(REPORT, text);
	console.log(text);
}
