/** The definition of an ability, read again whenever the state of the station may be another. */
import type { Address, AbilityDefinition } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';

export class LiveDefinition {
	/** The last answer; null before the first. */
	value = $state.raw<AbilityDefinition | null>(null);
	/** Why the last question was not answered; null when it was. */
	refusal = $state.raw<Refusal | null>(null);
	readonly #path: Address;
	#asking = false;
	#again = false;

	constructor(name: string) {
		this.#path = `/api/v1/abilities/${encodeURIComponent(name)}/definition`;
	}

	/** Asks now, or once more when the answer that is awaited has come: however fast the state moves, one is on its way. */
	async look(): Promise<void> {
		this.#again = this.#asking;
		if (this.#asking) return;
		this.#asking = true;
		do {
			this.#again = false;
			const answer = await request<AbilityDefinition>('GET', this.#path);
			if (answer.ok) this.value = answer.value;
			this.refusal = answer.ok ? null : answer.refusal;
		} while (this.#wanted);
		this.#asking = false;
	}

	/** Whether it was asked for again meanwhile. */
	get #wanted(): boolean {
		return this.#again;
	}
}
