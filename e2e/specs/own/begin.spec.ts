/** A first station step by step: from few answers to a draft that is checked. */
import type { Locator, Page } from '@playwright/test';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { examine, findings, overflow, smallTargets } from '../../station/barriers.ts';
import { Drafting } from '../../station/drafting.ts';
import { Keyboard, Mouse, type Hand } from '../../station/hand.ts';
import { ADA, ERIK, EXECUTABLE, Station, VERA } from '../../station/station.ts';
import { expect, test as base } from '../../station/test.ts';

/** A station that has nothing but its name; `beside` runs on its network. */
const test = base.extend<{ model: string; beside: { readonly program: string; readonly given: readonly string[] } | null }>({
	actionTimeout: 20_000,
	beside: [null, { option: true }],
	model: async ({}, use) => {
		const folder = mkdtempSync(join(tmpdir(), 'model-'));
		const model = join(folder, 'my_cell');
		mkdirSync(model);
		writeFileSync(join(model, 'station.yaml'), 'name: my_cell\n');
		await use(model);
		rmSync(folder, { recursive: true });
	},
	station: async ({ model, beside }, use, info) => {
		const logs = join(import.meta.dirname, '../../artefacts/logs', `begin-${info.testId}`);
		const given = { byItself: false, devices: false, people: [ADA, ERIK, VERA], logs, model };
		const station = await Station.start(beside === null ? given : { ...given, beside: [beside.program, beside.given] });
		await use(station);
		await station.stop();
	}
});

const SRDF = `<?xml version="1.0"?>
<!-- As MoveIt's assistant writes it. -->
<robot name="cell">
	<group name="arm"><chain base_link="base" tip_link="tool0"/></group>
	<group_state name="home" group="arm"><joint name="pan" value="0"/><joint name="lift" value="-1.57"/></group_state>
	<group_state name="at_table" group="arm"><joint name="lift" value="-0.9"/><joint name="pan" value="0.6"/></group_state>
	<group_state name="broken" group="arm"><joint name="pan" value="0.6"/></group_state>
	<group_state name="open" group="hand"><joint name="finger" value="0.04"/></group_state>
</robot>`;

const steps = (page: Page): Locator => page.getByRole('navigation', { name: 'Steps' });
const toStep = (page: Page, step: string): Locator => steps(page).locator(`[data-step="${step}"]`);
const part = (page: Page): Locator => page.getByTestId('step');
const next = (page: Page): Locator => page.getByRole('link', { name: /^Next: / });
const heading = (page: Page, name: string): Locator => page.getByRole('heading', { name, exact: true, level: 2 });
const put = (page: Page): Locator => page.getByRole('button', { name: 'Put it into the draft' });
const dialog = (page: Page): Locator => page.getByRole('dialog');
const row = (page: Page, text: string | RegExp): Locator => part(page).locator('[data-row]').filter({ has: page.getByText(text) });
const suggested = (page: Page): Locator => page.getByRole('region', { name: 'Suggestions' });

/** What becomes of what is written is known. */
async function known(page: Page): Promise<void> {
	await expect(part(page)).toHaveAttribute('data-known', 'true');
}

/** It is in the draft, and the check finds nothing. */
async function checked(page: Page): Promise<void> {
	await expect(page).toHaveURL(/\/model$/);
	await expect(page.getByRole('region', { name: 'What comes next' })).toBeVisible();
	await expect(page.getByTestId('check')).toHaveAttribute('data-verdict', 'good', { timeout: 60_000 });
	await expect(page.getByRole('region', { name: 'Problems' })).toContainText('Nothing was found.');
}

test('from an empty station to a checked draft with a template, by mouse alone', async ({ browse, station, complaints }) => {
	test.setTimeout(300_000);
	const page = await browse(ERIK, '/model');
	const empty = page.getByRole('region', { name: 'This station is empty' });
	await empty.getByRole('link', { name: 'Build it step by step' }).click();
	await expect(heading(page, 'Station')).toBeVisible();
	await page.getByRole('button', { name: 'A bolt is tightened' }).click();
	await page.getByLabel('Title of the station').fill('My cell');
	for (const name of ['Station', 'Devices', 'Poses', 'Product', 'Never', 'Look and begin']) {
		await expect(heading(page, name)).toBeVisible();
		await known(page);
		if (name !== 'Look and begin') await expect(page.getByRole('complementary', { name: 'Documents' }).locator('.cm-content')).toBeVisible();
		await examine(page, `begin-${name.toLowerCase().replaceAll(' ', '-')}`);
		await page.setViewportSize({ width: 390, height: 844 });
		expect.soft(await overflow(page), `${name}: pixels to the right of a phone`).toBe(0);
		expect.soft(await smallTargets(page), `${name}: too small on a phone`).toEqual([]);
		await page.setViewportSize({ width: 1440, height: 900 });
		if (name !== 'Look and begin') await next(page).click();
	}
	await expect(part(page)).toContainText('The station is called “My cell”.');
	await put(page).click();
	await checked(page);
	// One change, with a way back where it is told.
	const drafting = await Drafting.of(station);
	expect((await drafting.files()).get('station.yaml')).toMatch(/^name: my_cell\ntitle: My cell\n/);
	await page.getByRole('button', { name: 'Take back' }).click();
	await expect(page.getByRole('region', { name: 'This station is empty' })).toBeVisible();
	expect([...(await drafting.files())]).toEqual([['station.yaml', 'name: my_cell\n']]);
	expect(complaints).toEqual([]);
});

/** A station of a robot and a person is said, with poses of an SRDF. */
async function say(page: Page, hand: Hand): Promise<void> {
	await hand.write(page.getByLabel('Title of the station'), 'Hand-over');
	await hand.press(next(page));
	for (const [kind, title] of [['Robot with named poses', 'UR arm'], ['Tool that runs until it is done', 'Glue gun'], ['Person with a watch', 'Worker']] as const) {
		await hand.press(part(page).getByRole('button', { name: kind }));
		await hand.write(part(page).getByRole('textbox', { name: 'Title' }).last(), title);
	}
	await expect(part(page).getByRole('textbox', { name: 'Name' }).nth(1)).toHaveValue('glue_gun');
	await hand.press(next(page));
	await hand.press(page.getByRole('button', { name: 'Import from SRDF…' }));
	await hand.write(dialog(page).getByLabel('Or its text'), SRDF);
	await expect(dialog(page)).toContainText('The joint lift is missing.');
	await hand.press(dialog(page).getByRole('checkbox', { name: /^home/ }));
	await hand.press(dialog(page).getByRole('checkbox', { name: /^at_table/ }));
	await hand.press(dialog(page).getByRole('button', { name: 'Import 2 poses' }));
	await expect(page.getByLabel('Joint angles: at table')).toHaveValue('0.6, -0.9');
	await hand.press(next(page));
	await hand.write(part(page).getByRole('textbox', { name: 'Title' }).first(), 'Frame');
	for (const title of ['raw', 'in place', 'glued']) {
		await hand.press(page.getByRole('button', { name: 'Add a state' }));
		await hand.write(part(page).locator('.state').last().getByRole('textbox', { name: 'Title' }), title);
	}
	const first = page.getByRole('group', { name: 'From raw to in place' });
	await hand.write(first.getByRole('textbox', { name: 'Title' }), 'Put the frame in');
	await hand.choose(first.getByLabel('Who does it'), 'Worker');
	const second = page.getByRole('group', { name: 'From in place to glued' });
	await hand.write(second.getByRole('textbox', { name: 'Title' }), 'Glue it');
	await hand.choose(second.getByLabel('Who does it'), 'Glue gun');
	await hand.press(second.getByRole('button', { name: 'A robot stands in a pose meanwhile' }));
	await hand.choose(second.getByLabel('Stands in the pose'), 'at table');
	await hand.press(next(page));
	await hand.press(suggested(page).getByRole('button', { name: 'Add: Never UR arm in the pose “at table” while Worker is busy.' }));
	await expect(suggested(page)).toBeHidden();
}

test('from nothing to a checked draft, by keyboard alone, with a reload in the middle', async ({ browse, station, complaints }) => {
	test.setTimeout(300_000);
	const page = await browse(ERIK, '/model');
	const hand = new Keyboard(page);
	await expect(page.getByRole('region', { name: 'This station is empty' })).toBeVisible();
	await page.keyboard.press('Control+k');
	await expect(page.getByRole('combobox')).toBeFocused();
	await page.keyboard.type('First station');
	await page.keyboard.press('Enter');
	await expect(page.getByRole('heading', { name: 'First station', level: 1 })).toBeVisible();
	await say(page, hand);
	await known(page);
	await page.reload();
	await expect(heading(page, 'Never')).toBeVisible();
	await expect(part(page)).toContainText('Never UR arm in the pose “at table” while Worker is busy.');
	await hand.press(next(page));
	await expect(part(page)).toContainText('Glue it: Glue gun brings it from in place to glued. Meanwhile UR arm is in the pose “at table”.');
	await expect(put(page)).toHaveAttribute('aria-disabled', 'false');
	await hand.press(put(page));
	await checked(page);
	const files = await (await Drafting.of(station)).files();
	expect([...files.keys()]).toEqual(expect.arrayContaining(['resources/ur_arm.yaml', 'resources/glue_gun.yaml', 'resources/worker.yaml', 'specifications.yaml']));
	// What was answered stays, for a second try.
	await page.goto('/begin');
	await expect(page.getByRole('button', { name: 'Start over…' })).toBeVisible();
	expect(complaints).toEqual([]);
});

test('what is wrong is said at its field once that was left, and leads there; nothing is lost without a server', async ({ browse, station, complaints }) => {
	test.setTimeout(300_000);
	const viewer = await browse(VERA, '/begin');
	await expect(viewer.getByRole('heading', { level: 1 })).toContainText('engineer');
	const page = await browse(ERIK, '/begin?step=poses');
	const hand = new Mouse(page);
	await expect(part(page)).toContainText('The station has no robot: there is nothing to do here.');
	await toStep(page, 'devices').click();
	await part(page).getByRole('button', { name: 'Robot with named poses' }).click();
	await part(page).getByRole('button', { name: 'Clamp, gripper or door' }).click();
	const names = part(page).getByRole('textbox', { name: 'Name' });
	await names.last().fill('robot');
	await known(page);
	await expect(names.last()).toHaveAttribute('aria-invalid', 'false');
	await hand.leave();
	await expect(names.last()).toHaveAttribute('aria-invalid', 'true');
	await expect(toStep(page, 'devices')).toHaveAttribute('data-wrong', 'true');
	await expect(toStep(page, 'product')).toHaveAttribute('data-wrong', 'false');
	await names.last().fill('clamp');
	await expect(names.last()).toHaveAttribute('aria-invalid', 'false');

	// Joints that are no numbers, and texts that are no SRDF.
	await next(page).click();
	await page.getByLabel('Joint angles: Home').fill('0, up');
	await hand.leave();
	await expect(part(page)).toContainText('Write numbers with commas between, 32 at most.');
	await page.getByRole('button', { name: 'Import from SRDF…' }).click();
	const text = dialog(page).getByLabel('Or its text');
	const told = dialog(page).getByRole('alert').first();
	for (const [bad, why] of [
		['<robot>\n\t<group_state name="home">\n</robot>', /This is no XML: line 3 cannot be read\./],
		['no XML at all', /This is no XML: line 1/],
		['<robot name="x"/>', /This has no group states/],
		['<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>\n<robot>&a;</robot>', /has a document type or entities of its own/],
		['<robot>&nowhere;</robot>', /This is no XML: line 1/]
	] as const) {
		await text.fill(bad);
		await expect(told).toHaveText(why);
	}
	const many = Array.from({ length: 2000 }, (_, n) => `<group_state name="p${n}" group="arm"><joint name="a" value="${n}"/></group_state>`);
	await dialog(page).getByLabel('File').setInputFiles({ name: 'cell.srdf', mimeType: 'application/xml', buffer: Buffer.from(`<robot>${many.join('')}</robot>`) });
	await expect(dialog(page)).toContainText('arm: 2000 poses');
	await dialog(page).getByRole('button', { name: 'Tick all: arm' }).click();
	await expect(dialog(page)).toContainText('There is room for 59 more.');
	expect(await findings(page)).toEqual([]);
	await page.keyboard.press('Escape');
	await page.getByLabel('Joint angles: Home').fill('');

	// In the last step all of it is said, each with the way there.
	await toStep(page, 'never').click();
	await part(page).getByRole('button', { name: 'Add a rule' }).click();
	await toStep(page, 'look').click();
	await expect(put(page)).toHaveAttribute('aria-disabled', 'true');
	await expect(part(page).getByRole('link', { name: 'Never: Choose one.' })).toBeVisible();
	await expect(part(page)).toContainText('still to put right');
	await part(page).getByRole('link', { name: /^Product: a name is missing/ }).click();
	await expect(heading(page, 'Product')).toBeVisible();
	await expect(part(page).getByRole('textbox', { name: 'Name' }).first()).toBeFocused();

	// A template does not take the place of what was written without a question.
	await toStep(page, 'station').click();
	await page.getByRole('button', { name: 'A part is picked and placed' }).click();
	await dialog(page).getByRole('button', { name: 'Cancel' }).click();
	await toStep(page, 'devices').click();
	await expect(part(page).getByRole('textbox', { name: 'Name' })).toHaveCount(2);

	// What is written while the server is gone is there when it is back.
	await page.context().setOffline(true);
	await names.first().fill('ur');
	await expect(page.getByRole('alert').filter({ hasText: 'Not read' })).toBeVisible();
	await page.context().setOffline(false);
	await known(page);
	await page.reload();
	await expect(names.first()).toHaveValue('ur');

	// Start over is asked first.
	await page.getByRole('button', { name: 'Start over…' }).click();
	await dialog(page).getByRole('button', { name: 'Start over', exact: true }).click();
	await expect(heading(page, 'Station')).toBeVisible();
	await toStep(page, 'devices').click();
	await expect(part(page)).toContainText('No device yet.');
	await expect(row(page, 'Robot')).toHaveCount(0);
	expect((await (await Drafting.of(station)).files()).size).toBe(1);
	expect(complaints.filter((each) => !each.includes('net::ERR_INTERNET_DISCONNECTED'))).toEqual([]);
});

test('two tabs write one station: each goes on from the other, none overwrites it, and what is called otherwise and made is said in words', async ({ browse, station, complaints }) => {
	test.setTimeout(200_000);
	const page = await browse(ERIK, '/begin');
	await page.getByRole('button', { name: 'A bolt is tightened' }).click();
	const title = page.getByLabel('Title of the station');
	await title.fill('First tab');
	const other = await page.context().newPage();
	await other.goto(new URL('/begin', page.url()).href);
	const otherTitle = other.getByLabel('Title of the station');
	await expect(otherTitle).toHaveValue('First tab');
	await otherTitle.fill('Second tab');
	await expect(title).toHaveValue('Second tab');
	await expect(page.getByRole('status').filter({ hasText: 'Another tab has gone on' })).toBeVisible();

	// One of them has not heard of what the other one wrote: nothing is overwritten, and a reload loses neither.
	const missed = async (called: string): Promise<void> =>
		page.evaluate((title) => {
			const key = Object.keys(localStorage).find((each) => each.startsWith('begin:')) ?? '';
			const stored = JSON.parse(localStorage.getItem(key) ?? '{}') as { revision: number; sketch: { title: string } };
			localStorage.setItem(key, JSON.stringify({ ...stored, revision: stored.revision + 1, tab: 'asleep', sketch: { ...stored.sketch, title } }));
		}, called);
	await missed('While it slept');
	await title.fill('Written here');
	const split = page.getByRole('alert').filter({ hasText: 'also written in another tab' });
	await expect(split).toBeVisible();
	await expect(otherTitle).toHaveValue('While it slept');
	await page.reload();
	await expect(title).toHaveValue('Written here');
	await expect(split).toBeVisible();
	await examine(page, 'begin-two-tabs');
	await split.getByRole('button', { name: 'Go on with what is here' }).click();
	await expect(split).toBeHidden();
	await expect(otherTitle).toHaveValue('Written here');
	await missed('While it slept again');
	await title.fill('Given up');
	await split.getByRole('button', { name: 'Go on with the other tab' }).click();
	await expect(title).toHaveValue('While it slept again');
	await page.reload();
	await expect(title).toHaveValue('While it slept again');
	await other.close();

	// Two steps that are called so too: what their operations are called is said, and is what the documents have.
	await toStep(page, 'product').click();
	const names = part(page).locator('.between').getByRole('textbox', { name: 'Name' });
	await names.first().fill('do_it');
	await names.last().fill('do_it');
	await expect(part(page).getByRole('status').filter({ hasText: 'the operation of this one is called do_it_by_operator.' })).toBeVisible();
	await toStep(page, 'look').click();
	await known(page);
	await expect(part(page)).toContainText('Several steps are called do_it: in the documents the operation of this one is called do_it_by_nutrunner.');
	await put(page).click();
	await checked(page);
	expect((await (await Drafting.of(station)).files()).get('operations.yaml')).toMatch(/^do_it_by_operator:[^]*^do_it_by_nutrunner:/m);

	// Nobody has made a dozen changes: what was made is said.
	await page.goto('/review');
	await expect(page.getByText('draft, new: 4 resources, operations, what must never be')).toBeVisible();
	// What a product is nobody says yet: nothing is told of products.
	await page.goto('/');
	const figures = page.getByRole('region', { name: 'Figures of the day' });
	await expect(figures.locator('dt')).toHaveText(['Available today']);
	expect(complaints).toEqual([]);
});

test.describe('with a node on the network', () => {
	test.use({ beside: { program: EXECUTABLE, given: ['emulate', 'models/single_bolt'] } });

	test('it becomes a device, whose topics are taken in; what is in the draft is replaced after a question', async ({ browse, station, complaints }) => {
		test.setTimeout(300_000);
		const drafting = await Drafting.of(station);
		await drafting.ask('POST', 'model/changes', { title: 'Old', edits: [{ kind: 'text', file: 'resources/old.yaml', was: null, text: 'title: Old\n' }] });
		const page = await browse(ERIK, '/begin');
		await page.getByRole('button', { name: 'A person and a clamp' }).click();
		await next(page).click();
		const network = page.getByRole('region', { name: 'From the network' });
		await expect(network.getByRole('button', { name: /^Add: / }).first()).toBeVisible({ timeout: 60_000 });
		await network.getByRole('button', { name: /^Add: / }).first().click();
		await part(page).getByRole('textbox', { name: 'Title' }).last().fill('Found one');
		const topics = part(page).locator('details').getByRole('checkbox', { checked: true });
		await expect(topics).not.toHaveCount(0);
		await toStep(page, 'look').click();
		await known(page);
		await put(page).click();
		await expect(dialog(page)).toContainText('resources/old.yaml');
		await dialog(page).getByRole('button', { name: 'Replace the draft' }).click();
		await expect(page).toHaveURL(/\/model$/, { timeout: 120_000 });
		// One that the operator of the template has already is named; the others are kept.
		const failed = page.getByRole('region', { name: 'What comes next' }).getByRole('listitem');
		await expect(failed).toHaveCount(1);
		await expect(failed).toContainText('/operator/task: ');
		const files = await drafting.files();
		expect(files.has('resources/old.yaml')).toBe(false);
		expect(files.get('resources/found_one.yaml')).toContain('/nutrunner/state:');
		expect(complaints).toEqual([expect.stringContaining('409')]);
	});
});
