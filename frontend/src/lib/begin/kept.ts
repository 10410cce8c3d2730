/**
 * What was written on the page and is not in the draft, kept in this browser for each station and person. Several tabs share it:
 * each writes only on top of what it has read, so none of them overwrites what another one wrote.
 */
import { readSketch, type Sketch } from './sketch.ts';

/** What is kept, and how often it has become another one. */
interface Stored {
	readonly revision: number;
	/** The tab that has written it. */
	readonly tab: string;
	readonly sketch: Sketch | null;
}

/** What another tab has made of it; `newer` where it knew what this one has written. */
export interface Elsewhere {
	readonly sketch: Sketch | null;
	readonly newer: boolean;
}

export type Shelf = Pick<Storage, 'getItem' | 'setItem' | 'removeItem'>;

export class Kept {
	readonly #key: string;
	readonly #tab = crypto.randomUUID();
	readonly #shared: () => Shelf;
	readonly #own: () => Shelf;
	/** What this tab has read or written last. */
	#revision = 0;
	#last = 'null';

	constructor(station: string, person: string, shared: () => Shelf = () => localStorage, own: () => Shelf = () => sessionStorage) {
		this.#key = `begin:${station}:${person}`;
		this.#shared = shared;
		this.#own = own;
	}

	/** What was kept; null where that is nothing. */
	read(): Sketch | null {
		const stored = this.#stored();
		this.#note(stored);
		return stored.sketch;
	}

	/** What this tab has set aside, as another one had written meanwhile; null for nothing. */
	aside(): Sketch | null {
		try {
			return readSketch(this.#own().getItem(this.#key));
		} catch {
			return null;
		}
	}

	/** Keeps it; null: nothing any more. False where another tab has written meanwhile: then nothing is changed. */
	keep(sketch: Sketch | null): boolean {
		const text = JSON.stringify(sketch);
		if (text === this.#last) return true;
		if (this.elsewhere() !== null) return false;
		this.force(sketch);
		return true;
	}

	/** Keeps it, whatever another tab has written. */
	force(sketch: Sketch | null): void {
		const next: Stored = { revision: Math.max(this.#revision, this.#stored().revision) + 1, tab: this.#tab, sketch };
		this.setAside(null);
		this.#note(next);
		try {
			this.#shared().setItem(this.#key, JSON.stringify(next));
		} catch {
			// As long as the page.
		}
	}

	/** Keeps it for this tab alone. */
	setAside(sketch: Sketch | null): void {
		try {
			if (sketch === null) this.#own().removeItem(this.#key);
			else this.#own().setItem(this.#key, JSON.stringify(sketch));
		} catch {
			// As long as the page.
		}
	}

	/** What another tab has written that this one has not read; null for nothing. */
	elsewhere(): Elsewhere | null {
		const { revision, sketch } = this.#stored();
		if (revision < this.#revision || JSON.stringify(sketch) === this.#last) return null;
		return { sketch, newer: revision > this.#revision };
	}

	#note({ revision, sketch }: Pick<Stored, 'revision' | 'sketch'>): void {
		this.#revision = revision;
		this.#last = JSON.stringify(sketch);
	}

	#stored(): Stored {
		const nothing: Stored = { revision: 0, tab: '', sketch: null };
		try {
			const text = this.#shared().getItem(this.#key);
			if (text === null) return nothing;
			const read = JSON.parse(text) as Partial<Stored>;
			// As it was kept before several tabs were told apart.
			if (typeof read.revision !== 'number') return { ...nothing, sketch: readSketch(text) };
			return { revision: read.revision, tab: read.tab ?? '', sketch: readSketch(JSON.stringify(read.sketch ?? null)) };
		} catch {
			return nothing; // a browser that keeps nothing
		}
	}
}
