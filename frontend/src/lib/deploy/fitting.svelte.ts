/** Whether the station can take the draft, asked again as the one or the other moves. */
import type { Transfer } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { findTransfer } from './send.ts';

/** Milliseconds between an answer and the next question. */
const REST = 3000;

export class Fitting {
	#answer = $state.raw<{ readonly number: number; readonly revision: number; readonly transfer: Transfer } | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	#answered = -Infinity;

	/** What is known of the draft after its change `number`; null where nothing is. */
	of(number: number): Transfer | null {
		return this.#answer?.number === number ? this.#answer.transfer : null;
	}

	/** Whether the state of the station is the one that was asked about. */
	isOf(number: number, revision: number): boolean {
		return this.#answer?.number === number && this.#answer.revision === revision;
	}

	/** Asks unless it is known, and not too often: with the draft after its change `number`, and a state. */
	look(number: number, revision: number): void {
		if (this.pending || this.isOf(number, revision) || performance.now() - this.#answered < REST) return;
		void this.ask(number, revision);
	}

	async ask(number: number, revision: number): Promise<void> {
		if (this.pending) return;
		this.pending = true;
		const answer = await findTransfer();
		this.pending = false;
		this.#answered = performance.now();
		this.refusal = answer.ok ? null : answer.refusal;
		if (answer.ok) this.#answer = { number, revision, transfer: answer.value };
	}
}
