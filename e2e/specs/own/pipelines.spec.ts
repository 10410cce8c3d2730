import type { Locator, Page } from '@playwright/test';
import { examine } from '../../station/barriers.ts';
import { Drafting } from '../../station/drafting.ts';
import { INA, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: null, byItself: false, devices: true, people: 'everybody', copied: 'bolt_tightening' });

const STATE = '/pipelines?of=%2Fur10%2Fstate';
const box = (page: Page, kind: string, name: string): Locator =>
	page.locator('.svelte-flow__node').filter({ hasText: kind }).filter({ has: page.getByText(name, { exact: true }) });
const steps = (page: Page): Locator => page.getByRole('list', { name: 'Steps' });
const stage = (page: Page, kind: string): Locator => steps(page).locator('.stage').filter({ hasText: kind });
const part = (page: Page): Locator => page.getByRole('region', { name: 'Chosen part' });
const field = (page: Page, name: string): Locator => part(page).locator(`[data-path="${name}"]`);
const dialog = (page: Page): Locator => page.getByRole('dialog');
const examples = (page: Page): Locator => page.getByRole('region', { name: 'Examples' });

test('the graph is live; a stage is added where it fits, set right, proven by an example, and taken back', async ({
	browse,
	complaints
}) => {
	test.setTimeout(200_000);
	const page = await browse(INA, STATE);
	await expect(box(page, 'Topic', '/ur10/state')).toBeVisible({ timeout: 30_000 });
	await expect(box(page, 'Stage', 'discretise')).toContainText('joint_positions → pose');
	await expect(box(page, 'Variable', 'robot.previous_pose')).toBeVisible();
	// What the robot says, and below it what it is told.
	await expect(page.locator('.svelte-flow__edge[data-id^="/ur10/state"]')).toHaveCount(5);
	await expect(box(page, 'Stage', 'undiscretise')).toContainText('target_pose → joint_positions');
	await expect(page.locator('[data-wire]').filter({ hasText: /[1-9][\d.]*\/s/ })).toBeVisible();
	await expect(page.locator('[data-wire]').filter({ hasText: 'pose = home' })).toBeVisible();
	await examine(page, 'pipelines');
	await page.setViewportSize({ width: 1440, height: 900 });

	// A record shows all its fields, with their types and what they are now.
	await page.locator('[data-wire]').filter({ hasText: 'pose = home' }).click();
	await expect(part(page).locator('[data-field="pose"]')).toContainText('home');
	await expect(part(page).locator('[data-field="joint_positions"]')).toContainText('real[6]');
	await part(page).getByRole('button', { name: 'Add a stage here…' }).click();
	const constant = dialog(page).locator('[data-kind="constant"]');
	await expect(constant).toContainText('is for outgoing topics');
	await expect(constant.getByRole('button')).toHaveAttribute('aria-disabled', 'true');
	await dialog(page).getByRole('button', { name: /debounce/ }).click();
	await expect(dialog(page)).toBeHidden();
	await expect(part(page).getByRole('heading', { name: /debounce/ })).toBeVisible();
	await expect(box(page, 'Stage', 'debounce')).toBeVisible();
	await expect(stage(page, 'debounce').locator('+ .edge')).toContainText('only in the draft');

	// What is wrong is said in the field, and where records meet it; what comes behind it is not guessed.
	await field(page, 'seconds').getByRole('textbox').fill('-1');
	await expect(field(page, 'seconds')).toContainText('The number is too small.');
	await field(page, 'seconds').getByRole('textbox').fill('0.2');
	await field(page, 'fields').locator('input').first().fill('mooving');
	await expect(stage(page, 'debounce')).toContainText('did you mean `moving`?');
	await expect(page.locator('.svelte-flow__edge').locator('.wrong')).toHaveCount(1);
	await expect(stage(page, 'remember')).toContainText('Nobody can say whether it fits');
	await expect(page.getByRole('link', { name: /^\/ur10\/state/ })).toContainText('1 error');
	await stage(page, 'remember').getByRole('link').click();
	await stage(page, 'remember').getByRole('link').click(); // which leads to where one is already
	await expect(part(page).getByRole('heading', { name: /remember/ })).toBeFocused();
	await page.getByRole('region', { name: 'Problems' }).getByRole('button', { name: /robot\.yaml:\d+/ }).first().click();
	await expect(field(page, 'fields').locator('input').first()).toBeFocused();
	await field(page, 'fields').locator('input').first().fill('moving');
	await expect(stage(page, 'debounce')).not.toContainText('did you mean');

	// What the station hears becomes an example, which is run as the draft is edited.
	await examples(page).getByRole('button', { name: 'Record the last message as an example…' }).click();
	await dialog(page).getByLabel('What it is an example of').fill('at home');
	await dialog(page).getByRole('button', { name: 'Record', exact: true }).click();
	await expect(examples(page).locator('[data-example="at home"]')).toHaveAttribute('data-standing', 'passed');
	const close = dialog(page).getByRole('button', { name: 'Close' });
	if (await close.isVisible()) await close.click();
	await steps(page).locator('[data-stage="2"]').click();
	await field(page, 'except').getByRole('button', { name: /^Add an entry/ }).click();
	await field(page, 'except').locator('input').nth(1).fill('home');
	await expect(examples(page).locator('[data-example="at home"]')).toHaveAttribute('data-standing', 'failed');
	await expect(examples(page).locator('[data-right="false"]').first()).toContainText('home');
	await page.getByRole('button', { name: /^Undo/ }).click();
	await expect(examples(page).locator('[data-example="at home"]')).toHaveAttribute('data-standing', 'passed');

	// A message of one's own is shown behind every stage.
	await examples(page).getByLabel('Message, as JSON').fill('{"joint_positions": [0.6, -1.2, 1.4, -1.77, -1.57, 0.6]}');
	await examples(page).getByRole('button', { name: 'Try', exact: true }).click();
	await expect(page.locator('[data-wire]').filter({ hasText: 'pose = above_engine' })).toBeVisible();
	await page.getByRole('button', { name: 'Show what passes now' }).first().click();
	await expect(page.locator('[data-wire]').filter({ hasText: 'pose = home' })).toBeVisible();
	expect(complaints).toEqual([]);
});

test('a pipeline is shaped in its picture: stages are dropped on wires, moved, copied, pasted and removed, and boxes stay where they are put', async ({
	browse,
	complaints
}) => {
	test.setTimeout(200_000);
	const page = await browse(INA, STATE);
	await expect(box(page, 'Topic', '/ur10/state')).toContainText(/moving\s*no/, { timeout: 30_000 });
	await expect(box(page, 'Variable', 'robot.pose')).toContainText('home');
	await expect(page.locator('.svelte-flow__node-lane').filter({ hasText: 'From Robot UR10' })).toContainText(/[1-9][\d.]* messages a second/);
	const kind = (name: string): Locator => page.locator(`[data-stage-kind="${name}"]`);
	const order = (): Promise<string[]> => steps(page).locator('.stage code').allTextContents();
	const wire = (text: string): Locator => page.locator('[data-wire]').filter({ hasText: text }).first();
	await page.getByRole('searchbox', { name: 'Find a stage' }).fill('new value counts');
	await expect(page.locator('[data-stage-kind]')).toHaveCount(1);

	// From the palette onto a wire; what does not fit there is said, and nothing is changed.
	await kind('debounce').dragTo(wire('pose = home'));
	await expect.poll(order).toEqual(['discretise', 'debounce', 'remember']);
	await expect(part(page).getByRole('heading', { name: /debounce/ })).toBeVisible();
	await page.getByRole('searchbox', { name: 'Find a stage' }).fill('constant');
	await expect(kind('constant')).toHaveAttribute('data-fits', 'false');
	await kind('constant').dragTo(box(page, 'Stage', 'discretise'));
	await expect(page.getByRole('alert').filter({ hasText: 'is for outgoing topics' })).toBeVisible();
	await expect.poll(order).toEqual(['discretise', 'debounce', 'remember']);
	await page.getByRole('alert').getByRole('button', { name: 'Close' }).click();

	// By keyboard: from box to box, cut, pasted elsewhere as YAML, removed and taken back.
	await box(page, 'Stage', 'debounce').focus();
	await page.keyboard.press('Control+x');
	await expect.poll(order).toEqual(['discretise', 'remember']);
	await box(page, 'Stage', 'discretise').focus();
	await page.keyboard.press('ArrowRight');
	await expect(box(page, 'Stage', 'remember')).toBeFocused();
	await page.keyboard.press('Enter');
	await expect(part(page).getByRole('heading', { name: /remember/ })).toBeVisible();
	await page.keyboard.press('Control+v');
	await expect.poll(order).toEqual(['discretise', 'remember', 'debounce']);
	await box(page, 'Stage', 'debounce').press('Delete');
	await expect.poll(order).toEqual(['discretise', 'remember']);
	await page.getByRole('status').getByRole('button', { name: 'Take back' }).last().click();
	await expect.poll(order).toEqual(['discretise', 'remember', 'debounce']);

	// A stage that is dragged onto another wire goes there; one that is dragged elsewhere stays there, for who put it there.
	const all = (): Promise<void> => page.getByRole('button', { name: 'Show all of it' }).click();
	await all();
	await box(page, 'Stage', 'debounce').dragTo(wire('2 fields'));
	await expect.poll(order).toEqual(['debounce', 'discretise', 'remember']);
	await all();
	await box(page, 'Stage', 'remember').dragTo(wire('2 fields'));
	await expect(page.getByRole('alert').filter({ hasText: 'it would not fit' })).toContainText('there is no field');
	await expect.poll(order).toEqual(['debounce', 'discretise', 'remember']);
	await page.getByRole('alert').getByRole('button', { name: 'Close' }).click();
	const topic = box(page, 'Topic', '/ur10/state');
	const at = async (): Promise<string> => topic.evaluate((element) => element.style.transform);
	const usual = await at();
	await topic.hover();
	await page.mouse.down();
	const from = await topic.boundingBox();
	await page.mouse.move((from?.x ?? 0) + 60, (from?.y ?? 0) + 95, { steps: 8 });
	await page.mouse.up();
	await expect.poll(at).not.toBe(usual);
	const put = await at();
	await topic.hover();
	await page.mouse.down();
	await page.mouse.move((from?.x ?? 0) + 200, (from?.y ?? 0) + 20, { steps: 8 });
	await expect.poll(at).not.toBe(put);
	await page.keyboard.press('Escape');
	await page.mouse.up();
	await expect.poll(at).toBe(put);
	await page.reload();
	await expect.poll(at, { timeout: 30_000 }).toBe(put);
	await page.getByRole('button', { name: 'Lay it all out again' }).click();
	await expect.poll(at).toBe(usual);

	// A field is drawn to what it becomes; what means nothing is said.
	await topic.locator('.svelte-flow__handle.source').dragTo(box(page, 'Topic', '/ur10/planning_scene/state').locator('.svelte-flow__handle.target'));
	await expect(page.getByRole('alert').filter({ hasText: 'nothing can lead' })).toBeVisible();

	// What was written elsewhere is pasted where a wire is chosen.
	await wire('2 fields').click();
	await page.evaluate(() => {
		const clipboardData = new DataTransfer();
		clipboardData.setData('text/plain', '- limit: {every: 2}');
		document.activeElement?.dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true }));
	});
	await expect.poll(order).toEqual(['limit', 'debounce', 'discretise', 'remember']);

	// Of the whole station what is looked for stands out.
	await page.goto('/pipelines');
	await page.getByRole('searchbox', { name: 'Find in the graph' }).fill('joint_positions undiscretise');
	await expect(page.getByText('1 of 1')).toBeVisible();
	await page.getByRole('button', { name: 'Open', exact: true }).click();
	await expect(part(page).getByRole('heading', { name: /undiscretise/ })).toBeVisible();
	expect(complaints).toEqual([]);
});

test('comments go along with a stage, nothing is cut or connected that cannot be, and no change is lost while the server is slow', async ({
	browse,
	station
}) => {
	test.setTimeout(200_000);
	const draft = await Drafting.of(station);
	await draft.change(
		'Comments',
		['resources/robot.yaml', '      - remember:\n', '      # where it came from,\n      # for the wall\n      - remember: # not of unknown\n'],
		['resources/robot.yaml', 'of: pose\n', 'of: pose # as it stands now\n']
	);
	const written = async (): Promise<string> => (await draft.files()).get('resources/robot.yaml') ?? '';
	const page = await browse(INA, STATE);
	const order = (): Promise<string[]> => steps(page).locator('.stage code').allTextContents();
	const alert = page.getByRole('alert');
	const clipboard = (): Promise<string> => page.evaluate(() => navigator.clipboard.readText());
	await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
	await expect(box(page, 'Stage', 'remember')).toBeVisible({ timeout: 30_000 });
	await expect.poll(order).toEqual(['discretise', 'remember']);

	// Cut and pasted before the other one, with all its comments; taken back, nothing is left of it.
	const before = await written();
	await steps(page).locator('[data-stage="1"]').click();
	await box(page, 'Stage', 'remember').focus();
	await expect(part(page).getByRole('heading', { name: /Remember a value/ })).toBeVisible();
	await page.keyboard.press('Control+c');
	await expect.poll(clipboard).toBe(
		'# where it came from,\n# for the wall\n- remember: # not of unknown\n    variable: previous_pose\n    of: pose # as it stands now\n    except: [unknown]\n'
	);
	await page.keyboard.press('Control+x');
	await expect.poll(order).toEqual(['discretise']);
	await page.keyboard.press('Control+v');
	await expect.poll(order).toEqual(['discretise', 'remember']);
	expect(await written()).toContain(
		'      # where it came from,\n      # for the wall\n      - remember: # not of unknown\n          variable: previous_pose\n          of: pose # as it stands now\n          except: [unknown]\n'
	);
	await expect(part(page).getByRole('heading', { name: /Remember a value/ })).toBeVisible();

	// What an undo takes away is no more chosen: the pipeline is.
	await page.getByRole('button', { name: /^Undo/ }).click();
	await expect.poll(order).toEqual(['discretise']);
	await expect(part(page).getByRole('heading', { name: '/ur10/state' })).toBeVisible();
	expect(new URL(page.url()).searchParams.get('at')).toBeNull();
	await page.getByRole('button', { name: /^Undo/ }).click();
	await expect.poll(order).toEqual(['discretise', 'remember']);
	expect(await written()).toBe(before);

	// The points of the one are those of the command, too: it is not cut, and that it is copied is said.
	await box(page, 'Stage', 'discretise').click();
	await expect(part(page).getByRole('heading', { name: /Number to name/ })).toBeVisible();
	await box(page, 'Stage', 'discretise').focus();
	await page.keyboard.press('Control+x');
	await expect(alert.filter({ hasText: 'only copied' })).toBeVisible();
	await expect.poll(order).toEqual(['discretise', 'remember']);
	expect(await clipboard()).toContain('values: # joint angles in rad\n      home: [0.0, -1.57');
	await alert.filter({ hasText: 'only copied' }).getByRole('button', { name: 'Close' }).click();

	// What is connected is not connected once more, over what is written.
	const joined = box(page, 'Variable', 'robot.pose');
	await page.getByRole('button', { name: 'Show all of it' }).click();
	await box(page, 'Topic', '/ur10/state').locator('.svelte-flow__handle.source').dragTo(joined.locator('.svelte-flow__handle.target'));
	await expect(alert.filter({ hasText: 'are connected already, by the field pose' })).toBeVisible();
	await expect(dialog(page)).toBeHidden();
	await alert.getByRole('button', { name: 'Close' }).last().click();
	expect(await written()).toBe(before);

	// The server takes its time: that is said, and a second change is done after the first.
	await page.route('**/api/v1/model/changes', async (route) => {
		await new Promise((resolve) => setTimeout(resolve, 1500));
		await route.continue();
	});
	await steps(page).locator('[data-edge="2"]').click();
	await page.locator('[data-stage-kind="limit"]').click();
	await page.locator('[data-stage-kind="tick"]').click();
	await expect(page.getByRole('status').filter({ hasText: '2 changes are being made' })).toBeVisible();
	await expect.poll(async () => (await order()).toSorted(), { timeout: 15_000 }).toEqual(['discretise', 'limit', 'remember', 'tick']);
	await expect(page.getByText('being made…')).toBeHidden();
	await page.unrouteAll({ behavior: 'wait' }); // what is still on its way goes on to the server

	// The focus stays with what is moved, by the button that still leads on.
	await expect.poll(order).toEqual(['discretise', 'remember', 'tick', 'limit']);
	const up = (n: number): Locator => steps(page).getByRole('button', { name: `Move stage ${n}, Limit the rate, up` });
	await up(4).press('Enter');
	await expect(up(3)).toBeFocused();
	await page.keyboard.press('Enter');
	await expect(up(2)).toBeFocused();
	await page.keyboard.press('Enter');
	await expect(steps(page).getByRole('button', { name: 'Move stage 1, Limit the rate, down' })).toBeFocused();
	await expect.poll(order).toEqual(['limit', 'discretise', 'remember', 'tick']);

	// On a tablet the stages stand in a row above the picture, and are dragged from there.
	await page.setViewportSize({ width: 768, height: 1024 });
	await page.getByRole('searchbox', { name: 'Find a stage' }).fill('debounce');
	await page.getByRole('button', { name: 'Show all of it' }).click();
	await page.locator('[data-stage-kind="debounce"]').dragTo(box(page, 'Stage', 'remember'));
	await expect.poll(order).toEqual(['limit', 'discretise', 'remember', 'debounce', 'tick']);

	// Who cannot change it copies, and cuts nothing: the clipboard is as it was.
	const other = await browse(VERA, STATE);
	await other.context().grantPermissions(['clipboard-read', 'clipboard-write']);
	await expect(box(other, 'Stage', 'remember')).toBeVisible({ timeout: 30_000 });
	await steps(other).locator('[data-stage="2"]').click();
	await box(other, 'Stage', 'remember').focus();
	await other.evaluate(() => navigator.clipboard.writeText('as it was'));
	await other.keyboard.press('Control+x');
	await expect(other.getByRole('alert').filter({ hasText: 'Nothing was cut' })).toBeVisible();
	expect(await other.evaluate(() => navigator.clipboard.readText())).toBe('as it was');
});

test('a pipeline is edited by keyboard alone; a viewer sees it all and can edit nothing @long', async ({ browse }) => {
	const page = await browse(INA, STATE);
	await expect(steps(page)).toBeVisible({ timeout: 30_000 });
	await steps(page).getByRole('button', { name: 'Add a stage at record 3' }).press('Enter');
	await expect(dialog(page).getByRole('heading')).toBeFocused();
	await dialog(page).getByRole('button', { name: /limit/ }).press('Enter');
	await expect(part(page).getByRole('heading', { name: /limit/ })).toBeVisible();
	await steps(page).getByRole('button', { name: 'Move stage 3, Limit the rate, up' }).press('Enter');
	await expect(steps(page).locator('[data-stage="1"][aria-current="true"]')).toContainText('limit');
	await steps(page).locator('[data-stage="1"]').press('Enter');
	await expect(part(page).getByRole('heading', { name: /limit/ })).toBeFocused();
	await steps(page).getByRole('button', { name: 'Remove stage 2, Limit the rate' }).press('Enter');
	await expect(stage(page, 'limit')).toHaveCount(0);
	await page.keyboard.press('Control+z');
	await expect(stage(page, 'limit')).toHaveCount(1);

	// A field is connected with what it can become, and not with what it cannot.
	await steps(page).locator('[data-edge="0"]').press('Enter');
	await expect(part(page).getByRole('heading', { name: 'Record 1' })).toBeFocused();
	await part(page).getByRole('button', { name: 'Make something of moving' }).press('Enter');
	await expect(dialog(page).locator('[data-fits="false"]').first()).toContainText('Not here:');
	await page.keyboard.press('Escape');
	await expect(dialog(page)).toBeHidden();

	const other = await browse(VERA, STATE);
	await expect(steps(other).locator('[data-stage="2"]')).toBeVisible({ timeout: 30_000 });
	await expect(other.getByText('You can look at the model.')).toBeVisible();
	await steps(other).locator('[data-stage="0"]').click();
	await expect(field(other, 'tolerance').getByRole('textbox')).toHaveAttribute('readonly');
	for (const name of [/^Undo/, /^Add a/, /^Remove/, /^Move/, /^Record the/])
		await expect(other.getByRole('button', { name })).toHaveCount(0);
	await expect(examples(other).getByRole('button', { name: 'Try', exact: true })).toBeVisible();
});

test('a topic of the network is added to a resource @long', async ({ browse, station }) => {
	const draft = await Drafting.of(station);
	const { body } = await draft.ask('GET', 'model/files');
	const { text = '' } = (body['files'] as Record<string, { text: string }>)['resources/operator.yaml'] ?? {};
	const [topic = ''] = /^topics:\n(?: {2}.*\n)+/m.exec(text) ?? [];
	expect(topic).toContain('/operator/task');
	await draft.change('no task', ['resources/operator.yaml', topic, '']);

	const page = await browse(INA, '/pipelines');
	await page.getByRole('button', { name: 'Add a topic…' }).click();
	await dialog(page).getByLabel('Search').fill('operator');
	await dialog(page).getByRole('radio', { name: '/operator/task' }).check();
	await dialog(page).getByLabel('Resource that it belongs to').selectOption({ label: 'Operator' });
	await dialog(page).getByLabel('Direction').selectOption('out');
	await dialog(page).getByRole('button', { name: 'Add', exact: true }).click();
	await expect(page.getByRole('heading', { name: '/operator/task' }).first()).toBeVisible({ timeout: 60_000 });
	await part(page).getByRole('link', { name: 'On the ROS network' }).click();
	await expect(page.getByRole('heading', { name: 'Topic /operator/task' })).toBeVisible();
	await page.getByRole('link', { name: 'Show its pipeline' }).click();
	await expect(steps(page)).toContainText('To the message');
});
