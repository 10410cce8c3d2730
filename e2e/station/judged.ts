/** Proposals as the page Restart gets them, and what is wrong with them: none may be false, lead nowhere, or contradict. */
import type { Page, Response } from '@playwright/test';

interface Offer {
	readonly kind: string;
	readonly title: string;
	readonly claims: readonly string[];
	readonly corrections: readonly unknown[];
	readonly left_out: readonly string[];
}

interface Advice {
	readonly offers: readonly Offer[];
}

interface LastErrand {
	readonly title: string;
	readonly done: boolean;
	readonly why: string;
}

export class Judged {
	/** The titles of all that was proposed, each once. */
	readonly proposed: string[] = [];
	readonly wrong: string[] = [];
	#errand: string | null = null;

	constructor(readonly restart: Page) {
		restart.on('response', (response) => void this.#heard(response).catch(() => undefined));
	}

	/** What is asked of a person must agree with how the station stands. */
	async look(watch: Page): Promise<void> {
		const answer = await this.restart.request.get(new URL('/api/v1/station', this.restart.url()).href);
		const { standing, last_errand } = (await answer.json()) as { standing: string; last_errand: LastErrand | null };
		if (last_errand !== null && !last_errand.done && this.#errand !== null)
			this.#note(`taken and not done: ${last_errand.title} (${last_errand.why})`);
		const face = await watch.locator('body').innerText();
		if (standing === 'stopped' && face.includes('Nothing to do')) this.#note('the watch has nothing to do while the station stands');
	}

	async #heard(response: Response): Promise<void> {
		const { pathname } = new URL(response.url());
		if (!response.ok()) return;
		if (pathname.endsWith('/operator-plans')) this.#errand = pathname;
		if (!pathname.endsWith('/recovery/proposals')) return;
		const { offers } = (await response.json()) as Advice;
		for (const [number, offer] of offers.entries()) {
			if (!this.proposed.includes(offer.title)) this.proposed.push(offer.title);
			if (offer.claims.length > 0) this.#note(`proposed as done though nobody has checked: ${offer.title}`);
			const acts = offers.slice(number + 1).find((other) => other.corrections.length === 0 && other.left_out.length === 0);
			if (offer.corrections.length > 0 && acts) this.#note(`${offer.title} comes before ${acts.title}`);
		}
	}

	#note(text: string): void {
		if (!this.wrong.includes(text)) this.wrong.push(text);
	}
}
