/** What follows when a model is built: it is checked, saved, deployed, tried, and runs until the bolt is tightened. */
import { spawnSync } from 'node:child_process';
import { dirname, join } from 'node:path';
import { expect, type Page } from '@playwright/test';
import { findings, overflow } from './barriers.ts';
import type { Builder } from './building.ts';
import { done, picture, variable } from './seen.ts';
import { EXECUTABLE, ROOT } from './station.ts';

const REVISION = 'First model';

/** Goes to a page by the rail. */
async function goTo({ page, hand }: Builder, title: string): Promise<void> {
	await hand.press(page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name: new RegExp(`^${title}\\b`) }));
	await expect(page.getByRole('heading', { name: title, level: 1 })).toBeVisible();
}

/** No barrier for anybody on the page as it is now, light and dark, and room for it on a tablet; pictures are kept. */
export async function looked(page: Page, name: string): Promise<void> {
	await picture(page, `first-${name}`);
	expect.soft(await findings(page), name).toEqual([]);
	await page.emulateMedia({ colorScheme: 'dark' });
	expect.soft(await findings(page, ['color-contrast']), `${name}, dark`).toEqual([]);
	await page.emulateMedia({ colorScheme: 'light' });
	const desk = page.viewportSize();
	await page.setViewportSize({ width: 768, height: 1024 });
	expect.soft(await overflow(page), `${name}: pixels to the right of a tablet`).toBe(0);
	await picture(page, `first-${name}-768`);
	if (desk) await page.setViewportSize(desk);
}

const need = (page: Page, name: string, met: boolean): Promise<void> =>
	expect(page.locator(`[data-need="${name}"]`)).toHaveAttribute('data-met', String(met), { timeout: 30_000 });

export async function check(builder: Builder): Promise<void> {
	const { page, hand } = builder;
	await goTo(builder, 'Model');
	await expect(page.getByTestId('check')).toHaveAttribute('data-verdict', 'good', { timeout: 60_000 });
	await expect(builder.problems).toContainText('Nothing was found.');
	await hand.press(page.getByRole('tab', { name: 'Problems' }));
	for (let tab = 0; tab < 2; tab++) await page.keyboard.press('ArrowRight');
	await expect(page.getByRole('tab', { name: 'Guards added' })).toBeFocused();
	await expect(page.locator('[data-guard="robot.move_to(at_bolt)"]')).toContainText('no_standing_tool_on_placed_bolt');
	await expect(page.locator('[data-guard="operator.place_bolt"]')).toBeVisible();
	await looked(page, 'check');
}

export async function deploy(builder: Builder): Promise<void> {
	const { page, hand } = builder;
	await goTo(builder, 'Review changes');
	const bring = page.getByTestId('draft');
	const dialog = page.getByRole('dialog', { name: /^Deploy/ });
	await need(page, 'saved', false);
	await need(page, 'control', false);
	await looked(page, 'review-needs');
	await hand.press(bring.locator('[data-need="saved"]').getByRole('button', { name: 'Save revision…' }));
	const saving = page.getByRole('dialog', { name: 'Save the draft as a revision' });
	const save = saving.getByRole('button', { name: 'Save', exact: true });
	await hand.attempt(save);
	await expect(saving.getByRole('status').first()).toHaveText('It needs a name.');
	await hand.write(saving.getByLabel('Name'), REVISION);
	await hand.press(save);
	await need(page, 'saved', true);
	await hand.press(bring.getByRole('button', { name: 'Take control' }));
	for (const name of ['checked', 'standing', 'fits']) await need(page, name, true);
	await expect(page.locator('[data-need="control"]')).toHaveCount(0);
	await hand.press(bring.getByRole('button', { name: 'Deploy…' }));
	await hand.press(dialog.getByLabel(`I want “${REVISION}” to take the place of what runs.`));
	await hand.write(dialog.getByLabel('Reason'), 'The first model of the station');
	await looked(page, 'deploy');
	await hand.press(dialog.getByRole('button', { name: 'Deploy', exact: true }));
	await expect(page.getByTestId('deployment')).toHaveAttribute('data-phase', 'runs', { timeout: 60_000 });
	await expect(page.locator(`[data-revision="${REVISION}"]`)).toHaveAttribute('data-running', 'true');
	await expect(page.getByTestId('draft')).toContainText('There is nothing to bring: the station runs the draft.');
	await looked(page, 'deployed');
}

/** Tries the robot alone: it goes from home to above the bolt and back, while the station is paused. */
export async function tryAlone(builder: Builder): Promise<void> {
	const { page, hand } = builder;
	await hand.press(page.getByRole('link', { name: 'To Operate' }));
	await picture(page, 'first-operate');
	await hand.press(page.getByTestId('strip').getByRole('button', { name: 'Pause' }));
	await expect(page.getByTestId('mode')).toHaveAttribute('data-mode', 'paused');
	await expect(page.getByRole('button', { name: 'Take control' })).toHaveCount(0);
	await hand.press(page.getByRole('button', { name: 'Start production' }));
	await goTo(builder, 'Model');
	await builder.choose('move_to', 'resources/robot.yaml', 'abilities', 'move_to');
	const now = page.getByRole('region', { name: 'In the station that runs' });
	await hand.choose(now.getByRole('combobox', { name: 'Which one' }), 'Move to above');
	await hand.press(now.getByRole('button', { name: 'Try it' }));
	await hand.press(page.getByRole('region', { name: 'Try it' }).getByRole('button', { name: 'Try it' }));
	await expect(page.getByTestId('trial').locator('[data-step="finished"]')).toHaveAttribute('data-mark', 'done', {
		timeout: 30_000
	});
	await looked(page, 'tried');
}

/** Lets the station work until the bolt is tightened. */
export async function work(builder: Builder, watch: Page): Promise<void> {
	const { page, hand } = builder;
	await hand.press(page.getByTestId('strip').getByRole('button', { name: 'Continue' }));
	await hand.press(page.getByRole('link', { name: 'Operate', exact: true }));
	await expect(done(watch)).toHaveAttribute('aria-disabled', 'false', { timeout: 60_000 });
	await expect(watch.getByRole('heading').first()).toContainText('Place');
	await picture(page, 'first-asked');
	await done(watch).focus();
	await watch.keyboard.press('Enter');
	await expect(page.locator('[data-operation="tighten_bolt"]')).toHaveAttribute('data-completed', '1', { timeout: 60_000 });
	await looked(page, 'tightened');
	await hand.press(page.getByRole('link', { name: 'State', exact: true }));
	await expect(variable(page, 'bolt')).toHaveAttribute('data-value', 'tightened');
}

/** What is in the folder of the station means the same as the model of this repository. */
export function same(model: string): void {
	const args = [join(import.meta.dirname, 'same_meaning.py'), model, join(ROOT, 'models/single_bolt')];
	const ended = spawnSync(join(dirname(EXECUTABLE), 'python'), args, { encoding: 'utf8' });
	expect(ended.stdout + ended.stderr).toBe('');
	expect(ended.status).toBe(0);
}
