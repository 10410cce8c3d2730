/** One act of a person, from the press to its end: under way, done, or refused with words. */
import type { Refusal } from '#lib/rest/refusal.ts';

export class Act {
	pending = $state(false);
	refusal = $state.raw<Refusal | null>(null);

	/** Carries out `command` unless one is under way. True when it was accepted. */
	async run(command: () => Promise<Refusal | null>): Promise<boolean> {
		if (this.pending) return false;
		this.pending = true;
		this.refusal = null;
		this.refusal = await command();
		this.pending = false;
		return this.refusal === null;
	}
}
