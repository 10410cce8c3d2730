import type { Locator, Page } from '@playwright/test';
import { examine, findings } from '../station/barriers.ts';
import { copiedModel, Drafting } from '../station/drafting.ts';
import { ERIK, VERA } from '../station/station.ts';
import { expect, test as base } from '../station/test.ts';

const test = base.extend({
	station: async ({ bench }, use) => {
		const logs = new URL('../artefacts/logs/station', import.meta.url).pathname;
		await use(
			await bench.kept('station', { byItself: false, devices: false, people: [ERIK, VERA], logs, model: copiedModel() })
		);
	}
});

const at = (thing: string): string => `/station?${new URLSearchParams({ thing })}`;
const map = (page: Page): Locator => page.getByRole('group', { name: 'Map of the station' });
const piece = (page: Page, id: string): Locator => page.locator(`[data-stop="${id}"]`);
const chosen = (page: Page): Locator => page.getByRole('complementary', { name: 'What is chosen' });
const above = (page: Page): Locator => chosen(page).getByRole('region', { name: /^Above/ });
const below = (page: Page): Locator => chosen(page).getByRole('region', { name: /^Below/ });

test('from the goal of an operation down to the topic that carries it out, by mouse and by keyboard', async ({
	browse,
	complaints
}) => {
	const page = await browse(VERA, '/station');
	await expect(map(page).getByRole('heading', { level: 2 })).toHaveText([/^Layer 3/, /^Layer 2/, /^Layer 1/, /^Layer 0/]);
	await expect(map(page).locator('[data-layer="1"]').locator('[data-stop="ability:nutrunner.run_nut"]')).toBeVisible();
	await examine(page, 'station');
	await page.setViewportSize({ width: 1440, height: 900 });

	await piece(page, 'operation:prepare_planning_scene').click();
	await expect(page).toHaveURL(/thing=operation/);
	await expect(below(page).locator('[data-manner="goal"]')).toContainText('robot.tool_is_attached');
	await expect(below(page).locator('[data-manner="goal"]').getByRole('link')).toHaveText([/^operations\.yaml:\d+$/]);
	await expect(piece(page, 'variable:robot.tool_is_attached')).toHaveAttribute('data-tied', 'near');
	for (const far of ['ability:robot.attach_in_planning_scene', 'variable:robot.attach_tool', 'topic:/ur10/planning_scene/command'])
		await expect(piece(page, far)).toHaveAttribute('data-tied', 'far');
	await expect(piece(page, 'ability:nutrunner.run_nut')).toHaveAttribute('data-tied', 'not');
	await examine(page, 'station-chosen');
	await page.setViewportSize({ width: 1440, height: 900 });
	expect(complaints).toEqual([]);
});
