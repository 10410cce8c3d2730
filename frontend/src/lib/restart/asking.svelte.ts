/** A question of a person that takes a while: a plan to something, or why something is not so. */
import type { WayOffer, WhyNot } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import type { Answer } from '#lib/rest/request.ts';

export class Asking {
	offer = $state.raw<WayOffer | null>(null);
	why = $state.raw<WhyNot | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);

	/** Looks for a plan. What was found before is put away. */
	async plan(find: () => Promise<Answer<WayOffer>>): Promise<void> {
		const found = await this.#ask(find);
		if (found !== null) this.offer = found;
	}

	/** Looks for the reasons. What was found before is put away. */
	async reasons(find: () => Promise<Answer<WhyNot>>): Promise<void> {
		const found = await this.#ask(find);
		if (found !== null) this.why = found;
	}

	/** Puts away what was found. */
	forget(): void {
		this.offer = null;
		this.why = null;
		this.refusal = null;
	}

	async #ask<Found>(find: () => Promise<Answer<Found>>): Promise<Found | null> {
		if (this.pending) return null;
		this.forget();
		this.pending = true;
		const answer = await find();
		this.pending = false;
		if (answer.ok) return answer.value;
		this.refusal = answer.refusal;
		return null;
	}
}
