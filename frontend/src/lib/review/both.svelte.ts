/** The station as it would go on from its state now, with the model that runs and with the draft. */
import type { Value, WhatIf } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { DRAFT, RUNNING } from './comparing.svelte.ts';
import { simulate } from './send.ts';

/** Seconds that are simulated. */
export const SPAN = 60;

export class Both {
	found = $state.raw<{ readonly before: WhatIf; readonly after: WhatIf; readonly number: number } | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	#asking = $state.raw<AbortController | null>(null);
	readonly pending: boolean = $derived(this.#asking !== null);

	/** Simulates both from the same values, with the draft after its change `number`. */
	async ask(number: number, present: Record<string, Value | null>): Promise<void> {
		this.#asking?.abort();
		const asking = new AbortController();
		this.#asking = asking;
		this.refusal = this.found = null;
		const [before, after] = await Promise.all([simulate(RUNNING, SPAN, present, asking.signal), simulate(DRAFT, SPAN, present, asking.signal)]);
		if (this.#asking !== asking) return;
		this.#asking = null;
		if (before.ok && after.ok) this.found = { before: before.value, after: after.value, number };
		else this.refusal = before.ok ? (after.ok ? null : after.refusal) : before.refusal;
	}

	/** Nobody waits for it any more. */
	end(): void {
		this.#asking?.abort();
		this.#asking = null;
	}
}
