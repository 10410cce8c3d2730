/** Corrections that begin on a page: the one that is open, what was done, and the way back from it as long as the page is there. */
import { onDestroy } from 'svelte';
import type { Value } from '#lib/contract.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { say } from '#lib/text/text.svelte.ts';
import { toasts } from '#lib/ui/toasts.svelte.ts';
import { Correction } from './correction.svelte.ts';

export class Correcting {
	readonly #station: Station;
	/** Puts away what was told last. */
	#withdraw: (() => void) | undefined;
	/** The one that is open. */
	correction = $state.raw<Correction | null>(null);

	constructor(station: Station) {
		this.#station = station;
		onDestroy(() => this.#withdraw?.());
	}

	/** Opens the correction of an estimate; with a value, once it was seen what follows. */
	open(variable: string, value: Value | null = null): void {
		this.correction = new Correction(this.#station, [variable]);
		if (value === null) return;
		this.correction.choose(variable, value);
		void this.correction.look();
	}

	/** Tells what was done, with the way back. */
	readonly close = (done: string): void => {
		const made = this.correction;
		this.correction = null;
		if (done === '') return;
		this.#withdraw?.();
		this.#withdraw = toasts.tell(done, made?.isNew ? { word: say().state.last.undo, act: this.#undo } : null);
	};

	readonly #undo = (): null => {
		const last = this.#station.view?.last_correction;
		if (last) this.correction = new Correction(this.#station, Object.keys(last.values), last);
		return null;
	};
}
