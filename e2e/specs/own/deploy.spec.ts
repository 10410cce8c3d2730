import type { Locator, Page } from '@playwright/test';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import type { Replacement } from '../../station/drafting.ts';
import { startProduction } from '../../station/seen.ts';
import { ERIK, Station, VERA } from '../../station/station.ts';
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
	await need(page, 'fits', true);
	await expect(dialog).toContainText('Confirm that you want it.');
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
	await expect(page.getByText('No revision has been saved yet')).toBeVisible();
	await startProduction(page);
	await drafting.change('Rebuilt', ...REBUILT);
	await expect(page.getByTestId('draft')).toContainText('It differs from what runs in 2 files');

	await page.getByRole('button', { name: 'Deploy…' }).click();
	await need(page, 'saved', false);
	await need(page, 'standing', false);
	await need(page, 'control', true);
	await page.getByRole('dialog').getByRole('button', { name: 'Save revision…' }).click();
	const saving = page.getByRole('dialog', { name: 'Save the draft as a revision' });
	await saving.getByRole('button', { name: 'Save', exact: true }).press('Enter');
	await expect(saving.getByRole('status').first()).toHaveText('It needs a name.');
	await saving.getByLabel('Name').fill('x'.repeat(101));
	await expect(saving.getByRole('status').first()).toHaveText('The name is longer than 100 characters.');
	await saving.getByLabel('Name').fill('Rebuilt');
	await saving.getByLabel('Message').fill('The robot is out of the way before an engine moves.');
	await page.keyboard.press('Tab');
	await saving.getByRole('button', { name: 'Save', exact: true }).press('Enter');
	await need(page, 'saved', true);
	await page.keyboard.press('Escape');
	await expect(revision(page, 'Rebuilt')).toHaveAttribute('data-draft', 'true');
	await expect(revision(page, 'Rebuilt')).toContainText('Erik');
	await expect(revision(page, 'As the station was')).toHaveAttribute('data-running', 'true');
	await page.getByRole('button', { name: 'Save revision…' }).click();
	await expect(saving.getByRole('status').first()).toContainText('Nothing differs from the revision “Rebuilt”');
	await page.keyboard.press('Escape');

	await page.getByRole('button', { name: 'Compare with what runs', exact: true }).click();
	const compared = page.getByTestId('comparison');
	await expect(compared).toBeVisible({ timeout: 40_000 });
	const part = compared.locator('[data-part="engine.next_engine"]');
	await expect(part).toHaveAttribute('data-state', 'changed');
	await expect(part).toContainText('robot.pose == home and');
	await expect(compared.locator('[data-behaviour="engine.next_engine"]')).toContainText(
		/Only in the older one it can start\s+after \d+ starts/
	);
	const title = compared.locator('[data-file="station.yaml"] [data-line="added"]');
	await expect(title).toContainText('+ added');
	await expect(title).toContainText(`title: "${TITLED}"`);
	await examine(page, 'deploy');
	await page.setViewportSize({ width: 1440, height: 900 });

	await holdsTool(station);
	await page.getByRole('button', { name: 'Deploy…' }).click();
	await need(page, 'checked', true);
	await need(page, 'standing', false);
	await page.getByRole('dialog').getByRole('button', { name: 'Deploy', exact: true }).press('Enter');
	await expect(page.getByRole('dialog')).toContainText('missing.');
	const { body: draft } = await drafting.ask('GET', 'model');
	const { body: known } = await drafting.ask('GET', 'model/revisions');
	const [{ id }] = known['revisions'] as [{ id: string }];
	const refused = await drafting.ask('POST', 'model/deployments', {
		revision: id,
		number: draft['number'],
		reason: 'Without control'
	});
	expect(refused.status).toBe(409);
	await page.getByRole('dialog').getByRole('button', { name: 'Hold' }).click();
	await need(page, 'standing', true);
	await expect(page.getByRole('radio', { name: 'They go on as they stand.' })).toBeChecked();
	await deploy(page, 'Rebuilt');
	await expect(page).toHaveTitle(new RegExp(TITLED));
	await holdsTool(station);
	expect(readFileSync(join(station.model, 'station.yaml'), 'utf8')).toContain(TITLED);

	await page.getByRole('button', { name: 'Back to this revision… As the station was' }).click();
	await expect(page.getByRole('dialog')).toContainText('can be undone');
	await page.getByRole('button', { name: 'Take it back' }).click();
	await expect(revision(page, 'As the station was')).toHaveAttribute('data-draft', 'true');
	await good(page);
	await page.getByRole('button', { name: 'Deploy…' }).click();
	await need(page, 'control', true);
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
	const page = await browse(ERIK, '/deploy');
	await startProduction(page);
	await holdsTool(station);
	await page.getByRole('button', { name: 'Pause' }).click();
	await page.getByRole('button', { name: 'Deploy…' }).click();
	await need(page, 'standing', true);
	await expect(page.getByTestId('transfer')).toHaveAttribute('data-legal', 'false', { timeout: 30_000 });
	await expect(page.getByTestId('transfer')).toContainText('it would violate The robot never holds the tool');
	await need(page, 'fits', false);
	await examine(page, 'deploy-dialog');
	await page.setViewportSize({ width: 1440, height: 900 });
	const illegal = await drafting.ask('POST', 'model/deployments', { revision: id, number, reason: 'All the same' });
	expect(illegal.body['type']).toContain('not-legal');
	await page.keyboard.press('Escape');

	await drafting.change('Broken', ['operations.yaml', 'goal: bolts[pair] == placed', 'goal: nuts[pair] == placed']);
	const broken = await drafting.save('Broken');
	await page.getByRole('button', { name: 'Deploy…' }).click();
	await need(page, 'saved', true);
	await need(page, 'checked', false);
	await expect(page.locator('[data-need="checked"]')).toContainText('It cannot be used.', { timeout: 30_000 });
	const unchecked = await drafting.ask('POST', 'model/deployments', {
		revision: broken,
		number: await drafting.checked(),
		reason: 'All the same'
	});
	expect(unchecked.body['type']).toContain('check-found-errors');
	// The page and the refusal say the same of the first error, with its place.
	await expect(page.locator('[data-need="checked"]')).toContainText(String(unchecked.body['detail']));
	await page.keyboard.press('Escape');
	expect(complaints).toEqual([]);

	const viewer = await browse(VERA, '/deploy');
	await expect(viewer.getByText('As viewer you can look on and compare.')).toBeVisible();
	await expect(revision(viewer, 'Broken')).toBeVisible();
	await expect(viewer.getByRole('button', { name: /^(Save revision|Deploy|Back to)/ })).toHaveCount(0);
	expect(complaints).toEqual([]);
});
