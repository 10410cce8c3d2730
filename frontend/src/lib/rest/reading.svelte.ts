/** What an address of the server says, read again and again: the last answer, and why the last question failed. */
import type { Address } from '#lib/contract.ts';
import { titled } from '#lib/wording/titled.svelte.ts';
import type { Refusal } from './refusal.ts';
import { request } from './request.ts';

export class Reading<Value> {
	#value = $state.raw<Value | null>(null);
	/** The last answer; it stays when a later question fails. Null before the first. */
	readonly value: Value | null = $derived(titled(this.#value));
	/** Why the last question was not answered; null when it was. */
	refusal = $state.raw<Refusal | null>(null);
	/** Seconds by which the server's clock is ahead of this device's. */
	ahead = $state(0);
	readonly #path: Address;
	#asked = 0;

	constructor(path: Address) {
		this.#path = path;
	}

	/** Asks again. Of several answers that are on their way only the newest counts. */
	async again(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<Value>('GET', this.#path);
		if (asked !== this.#asked) return;
		if (answer.ok) {
			this.#value = answer.value;
			this.ahead = answer.ahead;
			this.refusal = null;
		} else this.refusal = answer.refusal;
	}

	/** Asks now and every `milliseconds`, while the page is in front; the result ends that. */
	every(milliseconds: number): () => void {
		return everyInFront(milliseconds, () => void this.again());
	}
}

/** Calls `work` now, every `milliseconds` while the page is in front, and when it comes there; the result ends that. */
export function everyInFront(milliseconds: number, work: () => void): () => void {
	const look = (): void => {
		if (document.visibilityState === 'visible') work();
	};
	look();
	const timer = setInterval(look, milliseconds);
	document.addEventListener('visibilitychange', look);
	return () => {
		clearInterval(timer);
		document.removeEventListener('visibilitychange', look);
	};
}
