/** How a person uses a page: with the mouse, or by the keyboard alone. */
import { expect, type Locator, type Page } from '@playwright/test';

export interface Hand {
	/** Presses a button, follows a link, ticks a box. */
	press(what: Locator): Promise<void>;
	/** Presses what is not possible now, to be told why. */
	attempt(what: Locator): Promise<void>;
	/** Puts a text in the place of what a field holds. */
	write(field: Locator, text: string): Promise<void>;
	/** Chooses by the words of the choice. */
	choose(field: Locator, words: string): Promise<void>;
	/** Chooses a row of a tree. */
	pick(row: Locator): Promise<void>;
	/** Goes on from the field that was written in. */
	leave(): Promise<void>;
}

export class Mouse implements Hand {
	constructor(readonly page: Page) {}

	press(what: Locator): Promise<void> {
		return what.click();
	}

	attempt(what: Locator): Promise<void> {
		return what.click({ force: true }); // else it is waited for until it is possible
	}

	async write(field: Locator, text: string): Promise<void> {
		if (!(await field.evaluate((element: HTMLElement) => element.isContentEditable))) return field.fill(text);
		// An editor hears of what is selected by a key at once; else an update of it may come first.
		await field.click();
		await this.page.keyboard.press('Control+a');
		if (text === '') await this.page.keyboard.press('Delete');
		else await this.page.keyboard.insertText(text);
	}

	async choose(field: Locator, words: string): Promise<void> {
		await field.selectOption({ label: words });
	}

	pick(row: Locator): Promise<void> {
		return row.click();
	}

	leave(): Promise<void> {
		return this.page.keyboard.press('Tab');
	}
}

/** More stops than a page has. */
const STOPS = 400;

/** Nothing but keys: what Tab does not come to cannot be used. */
export class Keyboard implements Hand {
	constructor(readonly page: Page) {}

	async press(what: Locator): Promise<void> {
		await this.goTo(what);
		const isBox = (await what.getAttribute('type')) === 'checkbox';
		await this.page.keyboard.press(isBox ? 'Space' : 'Enter');
	}

	attempt(what: Locator): Promise<void> {
		return this.press(what);
	}

	async write(field: Locator, text: string): Promise<void> {
		await this.goTo(field);
		await this.page.keyboard.press('Control+a');
		if (text === '') await this.page.keyboard.press('Delete');
		for (const [index, line] of text.split('\n').entries()) {
			if (index > 0) {
				await this.page.keyboard.press('Enter');
				await this.page.keyboard.press('Shift+Home'); // the editor indents as the line above; here the line says how far
			}
			await this.page.keyboard.type(line);
		}
	}

	async choose(field: Locator, words: string): Promise<void> {
		await this.goTo(field);
		const chosen = (): Promise<string> =>
			field.evaluate((element: HTMLSelectElement) => element.selectedOptions[0]?.label.trim() ?? '');
		await this.page.keyboard.press('Home');
		for (let n = 0; n < STOPS && (await chosen()) !== words; n++) await this.page.keyboard.press('ArrowDown');
		expect(await chosen()).toBe(words);
	}

	async pick(row: Locator): Promise<void> {
		await expect(row).toBeVisible();
		await this.goTo(this.page.locator('[role="treeitem"][tabindex="0"]'));
		await this.page.keyboard.press('Home');
		for (let n = 0; n < STOPS; n++) {
			// The focus follows a key with the next frames.
			await this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
			if (await row.evaluate((element) => element === document.activeElement)) break;
			await this.page.keyboard.press('ArrowDown');
		}
		await expect(row).toBeFocused();
		await this.page.keyboard.press('Enter');
	}

	leave(): Promise<void> {
		return this.page.keyboard.press('Tab');
	}

	/** Presses Tab, or Shift and Tab where it lies behind, until the focus is there. */
	async goTo(what: Locator): Promise<void> {
		await expect(what).toBeVisible();
		const where = (): Promise<'here' | 'before' | 'after'> =>
			what.evaluate((element) => {
				let focused: Element | null = document.activeElement;
				let host: Element = element;
				const root = element.getRootNode();
				if (root instanceof ShadowRoot) {
					if (root.activeElement === element) return 'here';
					host = root.host;
					if (focused === host) return 'after';
				}
				if (focused === element) return 'here';
				focused ??= document.body;
				return focused.compareDocumentPosition(host) & Node.DOCUMENT_POSITION_PRECEDING ? 'before' : 'after';
			});
		for (let n = 0; n < STOPS; n++) {
			const found = await where();
			if (found === 'here') return;
			await this.page.keyboard.press(found === 'before' ? 'Shift+Tab' : 'Tab');
		}
		throw new Error(`Tab does not come to ${String(what)}`);
	}
}
