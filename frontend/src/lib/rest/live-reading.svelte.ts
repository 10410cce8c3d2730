/** What an address of the server says, read again whenever the state of the station may be another. */
import type { Address } from '#lib/contract.ts';
import { titled } from '#lib/wording/titled.svelte.ts';
import type { Refusal } from './refusal.ts';
import { request } from './request.ts';

export class LiveReading<Value> {
	#value = $state.raw<Value | null>(null);
	/** The last answer; null before the first. */
	readonly value: Value | null = $derived(titled(this.#value));
	/** Why the last question was not answered; null when it was. */
	refusal = $state.raw<Refusal | null>(null);
	readonly #path: Address;
	#asking = false;
	#again = false;

	constructor(path: Address) {
		this.#path = path;
	}

	/** Asks now, or once more when the answer that is awaited has come: however fast the state moves, one is on its way. */
	async look(): Promise<void> {
		this.#again = this.#asking;
		if (this.#asking) return;
		this.#asking = true;
		do {
			this.#again = false;
			const answer = await request<Value>('GET', this.#path);
			if (answer.ok) this.#value = answer.value;
			this.refusal = answer.ok ? null : answer.refusal;
		} while (this.#wanted);
		this.#asking = false;
	}

	/** Whether it was asked for again meanwhile. */
	get #wanted(): boolean {
		return this.#again;
	}
}
