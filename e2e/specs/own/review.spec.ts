import type { Locator, Page } from '@playwright/test';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import type { Replacement } from '../../station/drafting.ts';
import { startProduction } from '../../station/seen.ts';
import { ADA, ERIK, Station, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

const TITLED = 'Bolt tightening station, rebuilt';
/** The station is called otherwise, and the next engine comes only when the robot is out of the way. */
const REBUILT: Replacement[] = [
	['station.yaml', 'title: {en: Bolt tightening station, sv: Station för skruvdragning}', `title: "${TITLED}"`],
	['resources/engine.yaml', 'enabled: >-\n', 'enabled: >-\n      robot.pose == home and\n']
];
const NO_TOOL: Replacement = [
	'specifications.yaml',
	'# Moving down',
	'no_tool:\n  title: The robot never holds the tool\n  forbidden: robot.tool_is_attached\n\n# Moving down'
];

/** Each test has a station of its own: it is another one after a deployment. */
test.use({ shared: null, byItself: false, devices: true, people: 'everybody', copied: 'bolt_tightening' });

const revision = (page: Page, name: string): Locator => page.locator(`[data-revision="${name}"]`);
const need = (page: Page, name: string, met: boolean): Promise<void> =>
	expect(page.locator(`[data-need="${name}"]`)).toHaveAttribute('data-met', String(met), { timeout: 30_000 });
const good = (page: Page): Promise<void> =>
	expect(page.getByTestId('draft')).toHaveAttribute('data-verdict', 'good', { timeout: 40_000 });

/** Lets the draft take the place of what runs, in the dialog that is open. */
async function deploy(page: Page, name: string): Promise<void> {
	const dialog = page.getByRole('dialog', { name: `Deploy “${name}”` });
	await expect(dialog.getByRole('status').filter({ hasText: 'Confirm that you want it.' })).toBeVisible({ timeout: 30_000 });
	await dialog.getByLabel(`I want “${name}” to take the place of what runs.`).check();
	await dialog.getByLabel('Reason').fill('The cell was rebuilt');
	await dialog.getByRole('button', { name: 'Deploy' }).click();
	await expect(dialog).toBeHidden({ timeout: 30_000 });
	await expect(page.getByTestId('deployment')).toHaveAttribute('data-phase', 'runs', { timeout: 60_000 });
	await expect(page.getByRole('heading', { name: `“${name}” runs` })).toBeVisible();
	await expect(revision(page, name)).toHaveAttribute('data-running', 'true');
}

async function holdsTool(station: Station): Promise<void> {
	const holds = async (): Promise<string | undefined> => new Map(await station.values()).get('robot.tool_is_attached');
	await expect.poll(holds, { timeout: 40_000 }).toBe('true');
}

test('a changed model is saved, compared, refused while at work, deployed when held, and rolled back @long', async ({
	station,
	drafting,
	browse,
	complaints
}) => {
	const page = await browse(ERIK, '/deploy');
	await expect(page).toHaveURL(/\/review$/);
	await expect(page.getByTestId('change')).toHaveText('Nothing to review');
	await expect(page.getByText('No revision has been saved yet')).toBeVisible();
	await startProduction(page);
	await drafting.change('Rebuilt', ...REBUILT);
	await expect(page.getByTestId('change')).toHaveText('What you have changed');
	await expect(page.getByText('draft, 2 changes')).toBeVisible();
	const rail = page.getByRole('link', { name: 'Review changes' });
	await expect(rail.locator('.badge')).toHaveText('2');

	const bring = page.getByTestId('draft');
	await need(page, 'saved', false);
	await need(page, 'standing', false);
	await expect(page.locator('[data-need="control"]')).toHaveCount(0);
	await bring.getByRole('button', { name: 'Save revision…' }).click();
	const saving = page.getByRole('dialog', { name: 'Save the draft as a revision' });
	await saving.getByRole('button', { name: 'Save', exact: true }).press('Enter');
	await expect(saving.getByRole('status').first()).toHaveText('It needs a name.');
	await saving.getByLabel('Name').fill('x'.repeat(101));
	await expect(saving.getByRole('status').first()).toHaveText('The name is longer than 100 characters.');
	await saving.getByLabel('Name').fill('Rebuilt');
	await saving.getByLabel('What it changes, and why').fill('The robot is out of the way before an engine moves.');
	await page.keyboard.press('Tab');
	await saving.getByRole('button', { name: 'Save', exact: true }).press('Enter');
	await need(page, 'saved', true);
	await expect(page.getByTestId('change')).toHaveText('The robot is out of the way before an engine moves.');
	await expect(page.getByText('station, revision 1')).toBeVisible();
	await expect(page.getByText(/saved .* as “Rebuilt”/)).toBeVisible();
	await expect(revision(page, 'Rebuilt')).toHaveAttribute('data-draft', 'true');
	await expect(revision(page, 'Rebuilt')).toContainText('Erik');
	await expect(revision(page, 'As the station was')).toHaveAttribute('data-running', 'true');
	await bring.getByRole('button', { name: 'Save revision…' }).click();
	await expect(saving.getByRole('status').first()).toContainText('Nothing differs from the revision “Rebuilt”');
	await page.keyboard.press('Escape');

	const compared = page.getByTestId('comparison');
	await expect(compared).toHaveAttribute('data-whole', 'true', { timeout: 60_000 });
	await expect(compared).toContainText(/compared in [\d.]+ s, over all .*states that can be reached/);
	const part = compared.locator('[data-part="engine.next_engine"]').first();
	await expect(part).toContainText('may start on other conditions');
	await expect(part).toHaveAttribute('data-tag', 'changed');
	await part.getByText('Before and after').click();
	await expect(part).toContainText('robot.pose == home and');
	const lost = compared.locator('[data-row="gone start engine.next_engine"]');
	await expect(lost).toContainText(/can no longer start where it could\s+changed\s+It\sis\sso\safter\s\d+\sstarts/);
	await expect(lost).toContainText('changed');
	await expect(page.getByTestId('both-plans')).toHaveAttribute('data-found', 'true', { timeout: 60_000 });
	const tabs = page.getByRole('tablist', { name: 'What is shown of the changes' });
	await tabs.getByRole('tab', { name: /^What will be different/ }).press('ArrowRight');
	await expect(tabs.getByRole('tab', { name: /^Files/ })).toBeFocused();
	const file = page.locator('[data-file="station.yaml"]');
	await expect(file.locator('[data-line="added"]')).toContainText('+ added');
	await expect(file.locator('[data-line="added"]')).toContainText(`title: "${TITLED}"`);
	await expect(file.getByRole('link', { name: 'Open in Model' })).toHaveAttribute('href', /^\/model\?file=station\.yaml&line=\d+$/);
	await tabs.getByRole('tab', { name: /^Files/ }).press('ArrowLeft');
	await examine(page, 'review');
	await page.setViewportSize({ width: 1440, height: 900 });

	await holdsTool(station);
	await need(page, 'checked', true);
	await need(page, 'standing', false);
	await expect(page.getByTestId('check')).toContainText(/Can be read.* s/);
	const { body: draft } = await drafting.ask('GET', 'model');
	const { body: known } = await drafting.ask('GET', 'model/revisions');
	const [{ id }] = known['revisions'] as [{ id: string }];
	const refused = await drafting.ask('POST', 'model/deployments', {
		revision: id,
		number: draft['number'],
		reason: 'Without control'
	});
	expect(refused.status).toBe(409);
	await bring.getByRole('button', { name: 'Hold' }).click();
	await need(page, 'standing', true);
	await need(page, 'fits', true);
	await bring.getByRole('button', { name: 'Deploy…' }).click();
	await expect(page.getByRole('radio', { name: 'They go on as they stand.' })).toBeChecked();
	await deploy(page, 'Rebuilt');
	await expect(page).toHaveTitle(new RegExp(TITLED));
	await holdsTool(station);
	expect(readFileSync(join(station.model, 'station.yaml'), 'utf8')).toContain(TITLED);

	await revision(page, 'As the station was').getByRole('button', { name: /^Compare with what runs/ }).click();
	await expect(page.getByText('From what runs to “As the station was”')).toBeVisible();
	await expect(compared).toHaveAttribute('data-whole', 'true', { timeout: 60_000 });
	await expect(compared.locator('[data-row="new start engine.next_engine"]')).toContainText('can start where it could not');
	await page.getByRole('button', { name: 'Back to the draft' }).click();
	await page.getByRole('button', { name: 'Restore… As the station was' }).click();
	await expect(page.getByTestId('takes-back')).toContainText('What has changed since “As the station was” is taken back:', { timeout: 40_000 });
	await expect(page.getByTestId('takes-back')).toContainText('may start on other conditions', { timeout: 40_000 });
	await expect(page.getByRole('dialog')).toContainText('can be undone');
	await page.getByRole('button', { name: 'Restore it' }).click();
	await expect(revision(page, 'As the station was')).toHaveAttribute('data-draft', 'true');
	await good(page);
	await bring.getByRole('button', { name: 'Deploy…' }).click();
	await page.getByRole('radio', { name: /^Reset the simulation/ }).check();
	await deploy(page, 'As the station was');
	await expect.poll(async () => new Map(await station.values()).get('robot.tool_is_attached')).toBe('false');
	await expect(page).toHaveTitle(/^Bolt tightening station ·/);
	await page.getByRole('link', { name: 'To Operate' }).click();
	await expect(page.getByTestId('mode')).toHaveAttribute('data-production', 'waiting');
	// Control is kept, and there is nothing to decide: this is all that a start takes.
	await page.getByRole('button', { name: 'Start production' }).click();
	await expect(page.getByTestId('mode')).not.toHaveAttribute('data-production', 'waiting');
	expect(complaints).toEqual([]);
});

test('what is not checked, or would be illegal, is not deployed, and the page says why @long', async ({
	station,
	drafting,
	browse,
	complaints
}) => {
	await drafting.change('No tool', NO_TOOL);
	const number = await drafting.checked();
	const id = await drafting.save('No tool');
	const page = await browse(ERIK, '/review');
	await startProduction(page);
	await holdsTool(station);
	await page.getByTestId('draft').getByRole('button', { name: 'Pause', exact: true }).click();
	await need(page, 'standing', true);
	await expect(page.getByTestId('transfer')).toHaveAttribute('data-legal', 'false', { timeout: 30_000 });
	await expect(page.getByTestId('transfer')).toContainText('it would violate The robot never holds the tool');
	await need(page, 'fits', false);
	await page.getByRole('button', { name: 'Deploy…' }).click();
	await expect(page.getByRole('dialog')).toContainText('1 thing is missing.');
	await examine(page, 'deploy-dialog');
	await page.setViewportSize({ width: 1440, height: 900 });
	const illegal = await drafting.ask('POST', 'model/deployments', { revision: id, number, reason: 'All the same' });
	expect(illegal.body['type']).toContain('not-legal');
	await page.keyboard.press('Escape');

	await drafting.change('Broken', ['operations.yaml', 'goal: bolts[pair] == placed', 'goal: nuts[pair] == placed']);
	const broken = await drafting.save('Broken');
	await need(page, 'saved', true);
	await need(page, 'checked', false);
	await expect(page.getByTestId('comparison')).toContainText('The behaviour cannot be compared:', { timeout: 30_000 });
	await expect(page.getByTestId('check').getByRole('link', { name: /^operations\.yaml:\d+/ })).toBeVisible();
	await expect(page.locator('[data-need="checked"]')).toContainText('It cannot be used.', { timeout: 30_000 });
	const unchecked = await drafting.ask('POST', 'model/deployments', {
		revision: broken,
		number: await drafting.checked(),
		reason: 'All the same'
	});
	expect(unchecked.body['type']).toContain('check-found-errors');
	// The page and the refusal say the same of the first error, with its place.
	await expect(page.locator('[data-need="checked"]')).toContainText(String(unchecked.body['detail']));
	expect(complaints).toEqual([]);

	// Somebody else who reads it is told who has changed it meanwhile.
	const other = await browse(ADA, '/review');
	await expect(other.getByTestId('change')).toHaveText('Broken');
	await expect(other.getByTestId('check')).toHaveAttribute('data-verdict', 'unusable', { timeout: 30_000 });
	await drafting.change('Mended', ['operations.yaml', 'goal: nuts[pair] == placed', 'goal: bolts[pair] == placed']);
	await expect(other.getByText('Erik has just changed something: Mended.')).toBeVisible();
	await expect(other.getByTestId('change')).toHaveText('No tool');
	await drafting.change('Called otherwise', ...REBUILT.slice(0, 1));
	await expect(other.getByTestId('change')).toHaveText('What Erik has changed');
	await other.getByRole('button', { name: 'Put away' }).click();
	await expect(other.getByText('Erik has just changed something')).toHaveCount(0);

	const viewer = await browse(VERA, '/review');
	await expect(viewer.getByText('As viewer you can look on and compare. To save, restore and deploy takes the role engineer.')).toBeVisible();
	await expect(revision(viewer, 'Broken')).toBeVisible();
	await expect(viewer.getByRole('button', { name: /^(Save revision|Deploy|Pause now|Restore)/ })).toHaveCount(0);
	expect(complaints).toEqual([]);
});

test('engineers talk about a draft, and it waits for the product to be done', async ({ drafting, browse, complaints }) => {
	const page = await browse(ERIK, '/review');
	const other = await browse(VERA, '/review');
	await startProduction(page);
	await drafting.change('Retitled', ['station.yaml', 'title: {en: Bolt tightening station, sv: Station för skruvdragning}', `title: "${TITLED}"`]);
	const { body: draft } = await drafting.ask('GET', 'model');
	const saved = await drafting.ask('POST', 'model/revisions', { number: draft['number'], name: 'Retitled' });
	expect(saved.status).toBe(201);

	await page.getByRole('tab', { name: /^Talk/ }).click();
	await expect(page.getByText('Nobody has said anything of this draft yet.')).toBeVisible();
	const field = page.getByLabel('Say something to the other engineers');
	await field.fill('The name is on the door.\nPlease look.');
	await field.press('Control+Enter');
	await expect(field).toHaveValue('');
	await other.getByRole('tab', { name: /^Talk/ }).click();
	await expect(other.getByRole('listitem').filter({ hasText: 'The name is on the door.' })).toContainText('Erik');
	await expect(other.getByLabel('Say something to the other engineers')).toHaveCount(0);

	const bring = page.getByTestId('draft');
	await good(page);
	await bring.getByRole('button', { name: 'Deploy when this product is done…' }).click();
	const dialog = page.getByRole('dialog', { name: 'Deploy “Retitled” when this product is done' });
	await dialog.getByLabel('Reason').fill('A better name');
	await dialog.getByRole('button', { name: 'Plan it' }).click();
	await expect(dialog).toBeHidden();
	for (const each of [page, other]) {
		await expect(each.getByTestId('planned')).toContainText('“Retitled” is deployed when the product in work is done.');
		await expect(each.getByTestId('cycle-stop')).toHaveText('then pauses');
	}
	await examine(page, 'review-planned');
	// Who pauses before takes it out of the product's hands, and is told so.
	await page.getByRole('button', { name: 'Pause', exact: true }).first().click();
	await expect(page.getByTestId('planned')).toContainText('“Retitled” was not deployed');
	await bring.getByRole('button', { name: 'Put away' }).click();
	await expect(page.getByTestId('planned')).toHaveCount(0);
	await expect(other.getByTestId('planned')).toHaveCount(0);
	expect(complaints).toEqual([]);
});
