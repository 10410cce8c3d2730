/** Which parts of the forms are open: the same for all parts of the model, and kept in this browser. */
import { FIRST, type Fold } from './sections.ts';

const KEY = 'model-form';

export class Folding {
	#open = $state.raw<ReadonlySet<string>>(new Set(FIRST));

	constructor() {
		try {
			const kept: unknown = JSON.parse(localStorage.getItem(KEY) ?? 'null');
			if (Array.isArray(kept)) this.#open = new Set(kept.filter((each) => typeof each === 'string'));
		} catch {
			// As at first.
		}
	}

	isOpen(fold: Fold): boolean {
		return this.#open.has(fold);
	}

	set(fold: Fold, isOpen: boolean): void {
		if (isOpen === this.#open.has(fold)) return;
		this.#open = new Set(isOpen ? [...this.#open, fold] : [...this.#open].filter((each) => each !== fold));
		try {
			localStorage.setItem(KEY, JSON.stringify([...this.#open]));
		} catch {
			// Where nothing is kept, it is as at first the next time.
		}
	}
}
