/**
 * What was done, told for some seconds: one `toasts` serves all pages. Never for alarms, and never the only place of what has
 * to be known later.
 */
import type { Refusal } from '#lib/rest/refusal.ts';

/** Milliseconds that what was done is told, while nobody points at it and it has not the focus. */
export const SHOWN = 6000;
/** More than these would cover the page: the oldest goes. */
const MOST = 3;

/** The way back from what was done. */
export interface Back {
	/** What its button says; *Take back* where nothing is given. */
	readonly word?: string;
	/** Takes it back, or opens what does; what it gives is why that was refused. */
	readonly act: () => Promise<Refusal | null> | null;
}

export interface Toast {
	readonly id: number;
	readonly text: string;
	readonly back: Back | null;
}

class Toasts {
	#last = 0;
	/** The oldest first. */
	all = $state.raw<readonly Toast[]>([]);
	readonly #timers = new Map<number, ReturnType<typeof setTimeout>>();
	#held = false;

	/** Tells what was done; the result puts that away. */
	tell(text: string, back: Back | null = null): () => void {
		const toast = { id: ++this.#last, text, back };
		// What is said once more is told anew, and not twice.
		for (const same of this.all) if (same.text === text) this.close(same.id);
		for (const old of this.all.slice(0, Math.max(0, this.all.length + 1 - MOST))) this.close(old.id);
		this.all = [...this.all, toast];
		this.#wait(toast.id);
		return () => this.close(toast.id);
	}

	/** Puts one away. */
	close(id: number): void {
		clearTimeout(this.#timers.get(id));
		this.#timers.delete(id);
		this.all = this.all.filter((each) => each.id !== id);
	}

	/** Keeps them while somebody reads, or lets them go: each has its time once more. */
	hold(held: boolean): void {
		if (held === this.#held) return;
		this.#held = held;
		for (const timer of this.#timers.values()) clearTimeout(timer);
		this.#timers.clear();
		if (!held) for (const { id } of this.all) this.#wait(id);
	}

	#wait(id: number): void {
		if (!this.#held) this.#timers.set(id, setTimeout(() => this.close(id), SHOWN));
	}
}

export const toasts = new Toasts();
