/** What it costs a person to get a station back to work: how often they press, and how often they have to say or choose something. */
import type { Page } from '@playwright/test';

/** Where a press says or chooses something: a box, a card, an answer to a question. */
const DECIDES = 'label, input, select, [data-testid="question"], [role="dialog"]';

export class Clicks {
	presses = 0;
	decisions = 0;
	/** What was pressed, in its order. */
	readonly pressed: string[] = [];

	/** Counts every press on a page, whichever address it is at; from a page that is opened or reloaded after this. */
	static async on(page: Page): Promise<Clicks> {
		const clicks = new Clicks();
		await page.exposeFunction('pressedHere', (words: string, decides: boolean) => {
			clicks.presses += 1;
			if (decides) clicks.decisions += 1;
			clicks.pressed.push(words);
		});
		await page.addInitScript((decides) => {
			const note = (event: Event): void => {
				if (!event.isTrusted || !(event.target instanceof Element)) return;
				const thing = event.target.closest('button, a, label, input, select, summary') ?? event.target;
				const words = (thing.getAttribute('aria-label') ?? thing.textContent ?? '').trim().replaceAll(/\s+/g, ' ').slice(0, 60);
				const tell = (window as unknown as { pressedHere: (words: string, decides: boolean) => void }).pressedHere;
				tell(words, thing.closest(decides) !== null);
			};
			document.addEventListener('pointerdown', note, true);
		}, DECIDES);
		return clicks;
	}

	/** Counts anew. */
	clear(): void {
		this.presses = this.decisions = 0;
		this.pressed.length = 0;
	}
}
