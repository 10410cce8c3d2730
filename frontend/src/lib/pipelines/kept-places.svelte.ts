/** Where a person has put the boxes of pictures, kept in this browser. */
import type { Point } from '#lib/flow/layout.ts';

/** Of so many pictures at most it is kept: the ones that were changed last. */
const MOST = 100;

type Kept = Record<string, Record<string, readonly [x: number, y: number]>>;

/** Places in rem, by box and picture, of one person, in the pipelines of the draft or of an example. */
export class KeptPlaces {
	readonly #key: string;
	#kept = $state.raw<Kept>({});

	constructor(person: string, example: string | null = null) {
		this.#key = `pipelines-places:${person}${example === null ? '' : `:${example}`}`;
		try {
			const kept: unknown = JSON.parse(localStorage.getItem(this.#key) ?? '{}');
			if (typeof kept === 'object' && kept !== null && !Array.isArray(kept)) this.#kept = kept as Kept;
		} catch {
			// A browser that keeps nothing, or something else.
		}
	}

	/** The boxes of a picture that somebody has put somewhere. */
	of(picture: string): ReadonlyMap<string, Point> {
		const places = Object.entries(this.#kept[picture] ?? {});
		return new Map(places.flatMap(([id, place]) => (Array.isArray(place) ? [[id, { x: Number(place[0]) || 0, y: Number(place[1]) || 0 }]] : [])));
	}

	put(picture: string, places: ReadonlyMap<string, Point>): void {
		const { [picture]: before, ...others } = this.#kept;
		const now = Object.fromEntries([...places].map(([id, { x, y }]): [string, [number, number]] => [id, [round(x), round(y)]]));
		const kept = [...Object.entries(others), [picture, { ...before, ...now }] as const];
		this.#keep(Object.fromEntries(kept.slice(-MOST)));
	}

	/** All of a picture stands where it would by itself. */
	clear(picture: string): void {
		const { [picture]: _, ...others } = this.#kept;
		this.#keep(others);
	}

	#keep(kept: Kept): void {
		this.#kept = kept;
		try {
			localStorage.setItem(this.#key, JSON.stringify(kept));
		} catch {
			// As long as the page.
		}
	}
}

const round = (length: number): number => Math.round(length * 100) / 100;
