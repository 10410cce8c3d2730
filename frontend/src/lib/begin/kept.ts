/** What was written on the page and is not in the draft, kept in this browser for each station and person. */
import { readSketch, type Sketch } from './sketch.ts';

export class Kept {
	readonly #key: string;

	constructor(station: string, person: string) {
		this.#key = `begin:${station}:${person}`;
	}

	/** What was kept; null where that is nothing. */
	read(): Sketch | null {
		try {
			return readSketch(localStorage.getItem(this.#key));
		} catch {
			return null; // a browser that keeps nothing
		}
	}

	/** Keeps it; null: nothing any more. */
	keep(sketch: Sketch | null): void {
		try {
			if (sketch === null) localStorage.removeItem(this.#key);
			else localStorage.setItem(this.#key, JSON.stringify(sketch));
		} catch {
			// As long as the page.
		}
	}
}
