/** What a correction would bring about, as it was found last. */
import { previewCorrection } from '#lib/command/send.ts';
import type { CorrectionPreview, Value } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';

export class Preview {
	found = $state.raw<CorrectionPreview | null>(null);
	/** Why it was not found; null when it was. */
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	readonly #values: Readonly<Record<string, Value>>;

	constructor(values: Readonly<Record<string, Value>>) {
		this.#values = values;
	}

	/** Finds it out for the state as it is now. */
	async look(): Promise<void> {
		if (this.pending) return;
		this.pending = true;
		const answer = await previewCorrection(this.#values);
		this.pending = false;
		if (answer.ok) this.found = answer.value;
		this.refusal = answer.ok ? null : answer.refusal;
	}
}
