/** The editors of the page Model. */
import type { Locator } from '@playwright/test';

/**
 * Writes a text into an editor in the place of what is there, with keys that it knows. `fill` selects what is there behind
 * its back, and one that is being made at that moment puts the text before it.
 */
export async function write(editor: Locator, text: string): Promise<void> {
	await editor.focus();
	await editor.press('ControlOrMeta+a');
	await editor.page().keyboard.insertText(text);
}
