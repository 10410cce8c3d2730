/** Two versions of the model that are compared, and what came of it. */
import type { Comparison } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { compare } from './send.ts';

export const DRAFT = 'draft';
export const RUNNING = 'running';

/** Milliseconds between two looks at the clock. */
const LOOK = 1000;

export interface Compared {
	readonly old: string;
	readonly new: string;
	/** The change after which the draft was compared. */
	readonly number: number;
	readonly result: Comparison;
}

export class Comparing {
	old = $state<string>(RUNNING);
	new = $state<string>(DRAFT);
	found = $state.raw<Compared | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	/** Seconds for which an answer has been waited for. */
	seconds = $state(0);

	/** Compares the two, with the draft after its change `number`. */
	async ask(number: number): Promise<void> {
		if (this.pending || this.old === this.new) return;
		const asked = { old: this.old, new: this.new, number };
		this.pending = true;
		this.refusal = this.found = null;
		const began = performance.now();
		this.seconds = 0;
		const timer = setInterval(() => (this.seconds = Math.floor((performance.now() - began) / 1000)), LOOK);
		const answer = await compare(asked.old, asked.new);
		clearInterval(timer);
		this.pending = false;
		if (answer.ok) this.found = { ...asked, result: answer.value };
		else this.refusal = answer.refusal;
	}

	/** Whether what was found is not about the draft as it is after its change `number`. */
	isOutdated(number: number): boolean {
		const { found } = this;
		return found !== null && found.number !== number && [found.old, found.new].includes(DRAFT);
	}

	/** What runs is another model now: what was found of the one before is let go. */
	forget(): void {
		if (this.found !== null && [this.found.old, this.found.new].includes(RUNNING)) this.found = null;
	}
}
