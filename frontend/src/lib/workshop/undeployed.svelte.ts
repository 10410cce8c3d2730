/** In how many places the draft differs from what runs, for those who can change that; as it was told last. */
import type { DraftChanges } from '#lib/contract.ts';
import { everyInFront } from '#lib/rest/reading.svelte.ts';
import { request } from '#lib/rest/request.ts';

/** Milliseconds between two questions, where no page is open that hears of the draft itself. */
const EVERY = 30_000;

class Undeployed {
	changes = $state(0);

	/** Asks from time to time; the result ends that. */
	follow(): () => void {
		return everyInFront(EVERY, () => void this.#ask());
	}

	async #ask(): Promise<void> {
		const answer = await request<DraftChanges>('GET', '/api/v1/model/changes');
		this.changes = answer.ok ? answer.value.changes : 0;
	}
}

export const undeployed = new Undeployed();
