/** An engineer who builds a model on the page Model. */
import { expect, type Locator, type Page } from '@playwright/test';
import type { Hand } from './hand.ts';
import type { Added, Field } from './single-bolt.ts';

/** Milliseconds in which a change is written to the draft, beside its check. */
const WRITTEN = 20_000;

/** Milliseconds in which the editor of a field is there. */
const LOADED = 700;

/** The fields of the dialog in which something is chosen; in the others it is written. */
const CHOICES = new Set(['Direction', 'What it says']);

export class Builder {
	constructor(
		readonly page: Page,
		readonly hand: Hand
	) {}

	get form(): Locator {
		return this.page.getByRole('region', { name: 'Chosen part' });
	}

	/** The file beside the form. */
	get file(): Locator {
		return this.page.getByRole('region', { name: 'File', exact: true }).locator('.cm-content');
	}

	get dialog(): Locator {
		return this.page.getByRole('dialog');
	}

	get problems(): Locator {
		return this.page.getByRole('region', { name: 'Problems' });
	}

	button(name: string): Locator {
		return this.form.getByRole('button', { name, exact: true });
	}

	textbox(label: string): Locator {
		return this.form.getByLabel(label, { exact: true });
	}

	/** The editor of a condition, of an action or of some lines. */
	editor(label: string): Locator {
		return this.form.getByRole('textbox', { name: label, exact: true }).and(this.page.locator('.cm-content'));
	}

	async addAll(parts: readonly Added[]): Promise<void> {
		for (const part of parts) await this.add(part);
	}

	/** Adds a part by its dialog, and fills its form in. */
	async add(part: Added): Promise<void> {
		const { what, name, asked = {}, fields = [], text, effects = [] } = part;
		await this.hand.press(this.button('Add…'));
		await this.hand.choose(this.dialog.getByLabel('What', { exact: true }), what);
		await this.hand.write(this.dialog.getByLabel('Name', { exact: true }), name);
		for (const [label, value] of Object.entries(asked)) {
			const field = this.dialog.getByLabel(label);
			if (CHOICES.has(label)) await this.hand.choose(field, value);
			else await this.hand.write(field, value);
		}
		await this.hand.press(this.dialog.getByRole('button', { name: 'Add', exact: true }));
		await expect(this.dialog).toBeHidden();
		await expect(this.form.getByRole('heading').first()).toContainText(name);
		await this.fill(fields);
		if (text !== undefined) await this.hand.write(this.form.locator('.cm-content'), text);
		await this.addAll(effects);
	}

	/** Looks for a part in the tree by its name, and chooses it. */
	async choose(name: string, file: string, ...path: string[]): Promise<void> {
		const id = [file, ...path.map(encodeURIComponent)].join('#');
		const search = this.page.getByLabel('Search: name or title');
		await this.hand.write(search, name);
		await this.hand.pick(this.page.locator(`[role="treeitem"][data-id="${id}"]`));
		await this.hand.write(search, '');
	}

	async fill(fields: readonly Field[], within = ''): Promise<void> {
		for (const field of fields) await this.#fill(field, within);
	}

	/** What leads to a field: the field itself, or the button that adds something to it. */
	#way(field: Field, label: string): Locator {
		switch (field.as) {
			case 'condition':
				return this.editor(label);
			case 'yaml':
				return this.button(`Add ${label} as YAML`);
			case 'seconds':
				return this.textbox(`${label}, From`);
			case 'list':
			case 'names':
				return this.button(`Add an entry: ${label}`);
			case 'part':
				return this.button(`Add: ${label}`);
			default:
				return this.textbox(label);
		}
	}

	/** Opens the sections of a form and what is behind *More*, where a field is not seen without that. */
	async reveal(way: Locator): Promise<void> {
		const isSeen = (): Promise<boolean> => way.waitFor({ timeout: LOADED }).then(() => true, () => false);
		const more = this.form.locator(':is(details.rest, details[data-section]):not([open]) > summary');
		while (!(await isSeen()) && (await more.count()) > 0) await this.hand.press(more.first());
	}

	async #fill(field: Field, within: string): Promise<void> {
		const label = within + field.label;
		await this.reveal(this.#way(field, label));
		switch (field.as) {
			case 'text':
				await this.hand.write(this.textbox(label), field.text);
				break;
			case 'choice':
				await this.hand.choose(this.textbox(label), field.text);
				break;
			case 'condition':
				await this.hand.write(this.editor(label), field.text);
				break;
			case 'yaml':
				await this.hand.press(this.button(`Add ${label} as YAML`));
				await this.hand.write(this.editor(`${label}: Written as YAML`), field.text);
				break;
			case 'seconds':
				await this.hand.write(this.textbox(`${label}, From`), field.from);
				if (field.to) await this.hand.write(this.textbox(`${label}, To`), field.to);
				break;
			case 'list':
				for (const [index, row] of field.rows.entries()) {
					await this.hand.press(this.button(`Add an entry: ${label}`));
					await this.hand.write(this.editor(`${label}, ${index + 1}`), row);
				}
				break;
			case 'names':
				for (const [index, [name, value]] of field.rows.entries()) {
					await this.hand.press(this.button(`Add an entry: ${label}`));
					await this.hand.write(this.textbox(`${label}, name ${index + 1}`), name);
					await this.hand.write(this.textbox(`${label}, value ${index + 1}`), value);
				}
				break;
			case 'part':
				await this.hand.press(this.button(`Add: ${label}`));
				await this.fill(field.fields, `${field.label}: `);
				return;
		}
		await this.hand.leave();
	}

	/** All that was typed is in the draft. */
	async written(): Promise<void> {
		await expect(this.form.locator('[data-dirty="true"]')).toHaveCount(0, { timeout: WRITTEN });
		await expect(this.page.getByText('Not written yet')).toBeHidden();
	}

	/** The check of the draft as it is now has come to its end, and has found nothing. */
	async clean(): Promise<void> {
		await this.written();
		await expect(this.page.getByTestId('check')).toHaveAttribute('data-verdict', 'good', { timeout: 60_000 });
		await expect(this.problems).toContainText('Nothing was found.');
	}
}
