/** Whether the station can take the draft, asked again as the one or the other moves. */
import type { Simulation, Transfer } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { findTransfer } from './send.ts';

/** Milliseconds between an answer and the next question. */
const REST = 3000;

/** The draft after its change `number`, a state of the station, and what shall become of the simulation. */
export interface Asked {
	readonly number: number;
	readonly revision: number;
	readonly simulation: Simulation;
}

export class Fitting {
	#answer = $state.raw<(Asked & { readonly transfer: Transfer }) | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	/** When the last answer came, on the clock of `performance.now`; null before the first. */
	answered = $state<number | null>(null);

	/** What is known of the draft, whatever the state of the station; null where nothing is. */
	of({ number, simulation }: Pick<Asked, 'number' | 'simulation'>): Transfer | null {
		const known = this.#answer;
		return known?.number === number && known.simulation === simulation ? known.transfer : null;
	}

	/** Whether that is what was asked about last. */
	isOf(asked: Asked): boolean {
		return this.of(asked) !== null && this.#answer?.revision === asked.revision;
	}

	/** Asks unless it is known, and not too often. */
	look(asked: Asked): void {
		const early = this.of(asked) !== null && performance.now() - (this.answered ?? -Infinity) < REST;
		if (!this.pending && !this.isOf(asked) && !early) void this.ask(asked);
	}

	async ask(asked: Asked): Promise<void> {
		if (this.pending) return;
		this.pending = true;
		const answer = await findTransfer(asked.simulation);
		this.pending = false;
		this.answered = performance.now();
		this.refusal = answer.ok ? null : answer.refusal;
		if (answer.ok) this.#answer = { ...asked, transfer: answer.value };
	}
}
