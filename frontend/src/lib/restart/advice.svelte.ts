/** The ways back as this page knows them: the last answer, which is kept while another is waited for. */
import type { AdviceAnswer } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { goesOnLooking, isDue, isSettled } from './due.ts';
import { merged } from './merge.ts';

/** Milliseconds in which the server answers, also where it has given itself more time. */
const PATIENCE = 12_000;

export class Advice {
	answer = $state.raw<AdviceAnswer | null>(null);
	/** Why the last question was not answered; null when it was. */
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	/** A person is at one of the offers: they stay as they are. */
	held = $state(false);
	/** The way that a person has chosen themselves, also while another step is open. */
	picked = $state<string | null>(null);
	/** It was taken: whatever is offered after that is nobody's choice yet. */
	spent = $state(false);
	/** Answers in a row for the same state. */
	#times = $state(0);
	#last = -Infinity;
	/** The question that is under way. */
	#looking: Promise<void> | null = null;

	/** The last answer, unless there was too little time for it and it is asked for again. */
	get settled(): AdviceAnswer | null {
		return this.answer && isSettled(this.answer, this.#times) ? this.answer : null;
	}

	/** Not all ways were looked for yet, and the search goes on by itself. */
	get unfinished(): boolean {
		return this.answer !== null && (this.pending ? !this.answer.complete : goesOnLooking(this.answer, this.#times));
	}

	/** A person chooses a way; null: nobody has. */
	pick(key: string | null): void {
		this.picked = key;
		this.spent = false;
	}

	/** Keeps the offers as they are, for as long as a person is at one of them. */
	hold(): void {
		this.held = true;
	}

	/** Lets go of them. What was taken is seen before anything is asked again. */
	release(): void {
		this.held = false;
		this.#last = performance.now();
	}

	/** Asks if it is time to, for a station whose state is at `revision`. */
	consider(revision: number): void {
		const since = performance.now() - this.#last;
		const asked = { answer: this.answer, refused: this.refusal !== null, times: this.#times, since };
		if (!this.held && isDue(asked, revision)) void this.look();
	}

	/** Asks, or waits for the question that is under way. */
	look(): Promise<void> {
		this.#looking ??= this.#ask().finally(() => (this.#looking = null));
		return this.#looking;
	}

	async #ask(): Promise<void> {
		this.pending = true;
		const answer = await request<AdviceAnswer>('GET', '/api/v1/recovery/proposals', { patience: PATIENCE });
		this.pending = false;
		this.#last = performance.now();
		if (!answer.ok) {
			this.refusal = answer.refusal;
			return;
		}
		this.refusal = null;
		this.#times = answer.value.revision === this.answer?.revision ? this.#times + 1 : 1;
		// Whoever opened a dialog meanwhile reads on undisturbed; it is asked again after that.
		if (!this.held) this.answer = merged(this.answer, answer.value);
	}
}
