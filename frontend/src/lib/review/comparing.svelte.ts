/** Two versions of the model that are compared, and what came of it by now. */
import type { Comparison } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { compare } from './send.ts';

export const DRAFT = 'draft';
export const RUNNING = 'running';

/** Milliseconds between two looks at the clock. */
const LOOK = 1000;
/** Seconds for which an answer waits for what is found next: what was read at once is seen at once. */
const FIRST = 0.2;
const NEXT = 1;

export interface Compared {
	readonly old: string;
	readonly new: string;
	/** The change after which the draft was compared. */
	readonly number: number;
	/** What follows from what is written was not asked for. */
	readonly writtenOnly: boolean;
	/** While it is `doing` something, not all of it is known. */
	readonly result: Comparison;
}

export class Comparing {
	old = $state<string>(RUNNING);
	new = $state<string>(DRAFT);
	found = $state.raw<Compared | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** Somebody has called it off before all was known. */
	cancelled = $state(false);
	/** Seconds for which it has been compared. */
	seconds = $state(0);
	/** What is asked for now is only what is written. */
	writesOnly = $state(false);
	#asking = $state.raw<AbortController | null>(null);
	readonly pending: boolean = $derived(this.#asking !== null);
	/** All is known of what was asked for last. */
	readonly whole: boolean = $derived(this.found !== null && !this.found.writtenOnly && this.found.result.doing === '');

	/**
	 * Compares the two, with the draft after its change `number`, or at first only what is written; what was under way is
	 * called off, and what was found of the same change stays until more is known.
	 */
	async ask(number: number, writtenOnly = false): Promise<void> {
		if (this.old === this.new) return;
		this.#asking?.abort();
		const asking = new AbortController();
		this.#asking = asking;
		const asked = { old: this.old, new: this.new, number, writtenOnly };
		const known = this.found;
		if (known?.old !== asked.old || known.new !== asked.new || known.number !== number) this.found = null;
		this.refusal = null;
		this.cancelled = false;
		this.writesOnly = writtenOnly;
		this.seconds = 0;
		const began = performance.now();
		const timer = setInterval(() => (this.seconds = Math.floor((performance.now() - began) / 1000)), LOOK);
		let wait = FIRST;
		while (this.#asking === asking) {
			const answer = await compare(asked.old, asked.new, writtenOnly, wait, asking.signal);
			if (this.#asking !== asking) break;
			if (!answer.ok) this.refusal = answer.refusal;
			else if (this.found === null || answer.value.parts !== null || answer.value.doing === '') this.found = { ...asked, result: answer.value };
			if (!answer.ok || answer.value.doing === '') this.#asking = null;
			wait = NEXT;
		}
		clearInterval(timer);
	}

	/** Calls it off; what is known by now stays. */
	cancel(): void {
		this.cancelled = this.pending;
		this.end();
	}

	/** Nobody waits for it any more. */
	end(): void {
		this.#asking?.abort();
		this.#asking = null;
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
