import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Builder } from '../station/building.ts';
import { Mouse } from '../station/hand.ts';
import { picture } from '../station/seen.ts';
import { PARTS, REST, STATION } from '../station/single-bolt.ts';
import { ERIK, EVA, Station } from '../station/station.ts';
import { expect, test as base } from '../station/test.ts';

/** A station with nothing in it but its name. */
const test = base.extend<{ model: string }>({
	model: async ({}, use) => {
		const folder = mkdtempSync(join(tmpdir(), 'model-'));
		const model = join(folder, 'single_bolt');
		mkdirSync(model);
		writeFileSync(join(model, 'station.yaml'), 'name: single_bolt\n');
		await use(model);
		rmSync(folder, { recursive: true });
	},
	station: async ({ model }, use, info) => {
		const logs = join(import.meta.dirname, '../artefacts/logs', `first-station-${info.testId}`);
		const station = await Station.start({ byItself: false, devices: true, people: [EVA, ERIK], logs, model });
		await use(station);
		await station.stop();
	}
});

test('from an empty station to a tightened bolt', async ({ browse, complaints }) => {
	test.setTimeout(200_000);
	const begun = Date.now();
	const lap = (what: string): void => console.log(what, Math.round((Date.now() - begun) / 100) / 10);
	const page = await browse(ERIK, '/model');
	const builder = new Builder(page, new Mouse(page));
	await expect(page.getByRole('tree')).toBeVisible();
	await picture(page, 'first-empty');
	await builder.fill(STATION);
	for (const [name, parts] of Object.entries(PARTS)) {
		await builder.addAll(parts);
		lap(name);
		await picture(page, `first-${name}`);
	}
	await builder.choose('A single bolt', 'station.yaml');
	await builder.fill([REST]);
	await builder.clean();
	lap('clean');
	await picture(page, `first-clean`);
	expect(complaints).toEqual([]);
});
