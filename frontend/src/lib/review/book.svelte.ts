/** The revisions, read whenever the draft is another one, and from time to time for what happens without it. */
import type { Revisions } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';

const EVERY = 10_000;

export class Book {
	readonly #reading = new Reading<Revisions>('/api/v1/model/revisions');
	/** As they were read last; null before that. */
	readonly value: Revisions | null = $derived(this.#reading.value);
	readonly refusal: Refusal | null = $derived(this.#reading.refusal);

	again(): Promise<void> {
		return this.#reading.again();
	}

	/** Reads them while the page is in front; the result ends that. */
	attach(): () => void {
		return this.#reading.every(EVERY);
	}
}
