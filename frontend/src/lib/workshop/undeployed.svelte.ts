/**
 * What of the draft is to be brought to the station, for those who can: in how many places it differs from what runs, and the
 * revision that waits for their approval; as it was told last.
 */
import type { DraftChanges, Workshop } from '#lib/contract.ts';
import { everyInFront } from '#lib/rest/reading.svelte.ts';
import { request } from '#lib/rest/request.ts';

/** Milliseconds between two questions, where no page is open that hears of the draft itself. */
const EVERY = 30_000;
/** The same where somebody else may wait for an answer. */
const EVERY_DUAL = 5000;

class Undeployed {
	changes = $state(0);
	/** The revision that waits for the approval of who is signed in; null for none. */
	waits = $state.raw<DraftChanges['waits']>(null);
	#asked = 0;
	#isFollowed = false;
	#heard = '';

	/** Asks from time to time, more often with `dual` approval; the result ends that. */
	follow(dual: boolean): () => void {
		this.#isFollowed = true;
		const stop = everyInFront(dual ? EVERY_DUAL : EVERY, () => void this.#ask());
		return () => {
			stop();
			this.#asked++;
			this.#isFollowed = false;
			this.waits = null;
		};
	}

	/** Takes note of what is told of the draft; whether it waits for somebody is asked for again where that may be otherwise now. */
	hear({ number, changes, comment }: Pick<Workshop, 'number' | 'changes' | 'comment'>): void {
		this.changes = changes;
		const heard = `${number} ${changes} ${comment ?? 0}`;
		if (heard === this.#heard) return;
		this.#heard = heard;
		if (this.#isFollowed) void this.#ask();
	}

	/** Of several answers that are on their way only the newest counts. */
	async #ask(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<DraftChanges>('GET', '/api/v1/model/changes');
		if (asked !== this.#asked) return;
		this.changes = answer.ok ? answer.value.changes : 0;
		const waits = answer.ok ? (answer.value.waits ?? null) : null;
		// What is the same is not told again.
		if (waits?.id !== this.waits?.id) this.waits = waits;
	}
}

export const undeployed = new Undeployed();
