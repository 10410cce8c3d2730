/** The page Model: the form of the chosen part, its file, what is wrong, and its editors. */
import type { Locator, Page } from '@playwright/test';

export const form = (page: Page): Locator => page.getByRole('region', { name: 'Chosen part' });
export const field = (page: Page, name: string): Locator => form(page).locator(`[data-path="${name}"]`).first();
/** The editor of a condition or an action. */
export const expression = (page: Page, label: string): Locator =>
	form(page).getByRole('textbox', { name: label, exact: true }).and(page.locator('.cm-content'));
export const file = (page: Page): Locator => page.getByRole('region', { name: 'File', exact: true }).locator('.cm-content');
/** Shows one of what is told of the draft below its form. */
export const panel = (page: Page, name: 'Problems' | 'Usages' | 'Guards added' | 'Tried runs' | 'Changes' | 'Could be shorter'): Promise<void> =>
	page.getByRole('tablist', { name: 'About the draft' }).getByRole('tab', { name }).click();
/** Opens a section of the form. */
export async function unfold(page: Page, name: 'Name and time' | 'Person' | 'Start' | 'Under way' | 'Finish'): Promise<void> {
	const section = form(page).locator('details[data-section]').filter({ has: page.getByText(name, { exact: true }) });
	await section.waitFor();
	if ((await section.getAttribute('open')) === null) await section.locator('> summary').click();
}
/** How the check of the draft stands. */
export const check = (page: Page): Locator => page.getByTestId('check').getByRole('status');
export const problems = (page: Page, name = 'Problems'): Locator => page.getByRole('region', { name, exact: true });

/**
 * Writes a text into an editor in the place of what is there, with keys that it knows. `fill` selects what is there behind
 * its back, and one that is being made at that moment puts the text before it.
 */
export async function write(editor: Locator, text: string): Promise<void> {
	await editor.focus();
	await editor.press('ControlOrMeta+a');
	await editor.page().keyboard.insertText(text);
}
