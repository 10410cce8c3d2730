/** What was said of the draft, read whenever somebody has said something. */
import type { Comments, Verdict } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';
import { addComment, reviewRevision } from './send.ts';

const EVERY = 60_000;

export class Talk {
	readonly #reading = new Reading<Comments>('/api/v1/model/comments');
	readonly comments: Comments['comments'] = $derived(this.#reading.value?.comments ?? []);
	readonly read: boolean = $derived(this.#reading.value !== null);
	readonly refusal: Refusal | null = $derived(this.#reading.refusal);

	again(): Promise<void> {
		return this.#reading.again();
	}

	/** Reads it while the page is in front; the result ends that. */
	attach(): () => void {
		return this.#reading.every(EVERY);
	}

	/** Says something; null when it was taken. */
	say(text: string): Promise<Refusal | null> {
		return this.#add(addComment(text));
	}

	/** Says what one thinks of a revision; null when it was taken. */
	judge(revision: string, verdict: Verdict, text: string): Promise<Refusal | null> {
		return this.#add(reviewRevision(revision, verdict, text));
	}

	async #add(asked: ReturnType<typeof addComment>): Promise<Refusal | null> {
		const answer = await asked;
		if (!answer.ok) return answer.refusal;
		await this.again();
		return null;
	}
}
