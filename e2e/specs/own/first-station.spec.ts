import type { Page } from '@playwright/test';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Builder } from '../../station/building.ts';
import { check, deploy, looked, same, tryAlone, work } from '../../station/first-run.ts';
import { Keyboard, Mouse, type Hand } from '../../station/hand.ts';
import { mistakes } from '../../station/mistakes.ts';
import { PARTS, REST, STATION } from '../../station/single-bolt.ts';
import { ADA, ERIK, EVA, Station } from '../../station/station.ts';
import { expect, test as base, WRIST } from '../../station/test.ts';

/** A station that has nothing but its name. */
const test = base.extend<{ model: string }>({
	actionTimeout: 20_000,
	model: async ({}, use) => {
		const folder = mkdtempSync(join(tmpdir(), 'model-'));
		const model = join(folder, 'single_bolt');
		mkdirSync(model);
		writeFileSync(join(model, 'station.yaml'), 'name: single_bolt\n');
		await use(model);
		rmSync(folder, { recursive: true });
	},
	station: async ({ model }, use, info) => {
		const logs = join(import.meta.dirname, '../../artefacts/logs', `first-station-${info.testId}`);
		const station = await Station.start({ byItself: false, devices: true, people: [ADA, EVA, ERIK], logs, model });
		await use(station);
		await station.stop();
	}
});

/** As docs/first-station.md leads through it; `between` is what else is done once the robot is there. */
async function build(builder: Builder, between: () => Promise<void>): Promise<void> {
	const { form, page } = builder;
	await expect(form.getByRole('heading').first()).toContainText('Station');
	await looked(page, 'empty');
	await test.step('the station, what is said, and the words for it', async () => {
		await builder.fill(STATION);
		await builder.addAll(PARTS.WORDS);
	});
	await test.step('the robot', () => builder.addAll(PARTS.ROBOT));
	await between();
	await test.step('the nutrunner', () => builder.addAll(PARTS.NUTRUNNER));
	await looked(page, 'nutrunner');
	await test.step('the operator', () => builder.addAll(PARTS.OPERATOR));
	await test.step('what must never be, what is wanted, and where it rests', async () => {
		await builder.addAll(PARTS.WANTED);
		await builder.choose('A single bolt', 'station.yaml');
		await builder.fill([REST]);
		await builder.clean();
	});
	await looked(page, 'model');
}

async function run(builder: Builder, watch: Page, model: string): Promise<void> {
	await test.step('it is checked', () => check(builder));
	await test.step('saved and deployed', () => deploy(builder));
	await test.step('the robot is tried alone', () => tryAlone(builder));
	await test.step('it works until the bolt is tightened', () => work(builder, watch));
	await test.step('and it is the model of this repository', () => same(model));
}

const HANDS: readonly (readonly [title: string, hand: (page: Page) => Hand])[] = [
	['with the mouse', (page) => new Mouse(page)],
	['by keyboard alone', (page) => new Keyboard(page)]
];

for (const [how, hand] of HANDS)
	test(`from an empty station to a tightened bolt, ${how} @long`, async ({ browse, model, complaints }) => {
		test.setTimeout(900_000);
		const page = await browse(ERIK, '/model');
		const builder = new Builder(page, hand(page));
		await build(builder, () => mistakes(builder));
		await run(builder, await browse(EVA, '/operator', WRIST), model);
		expect(complaints).toEqual([]);
	});
