/**
 * What every variable was during the last minute, as far as a line in a row of a table can show it.
 *
 * A station may have thousands of variables, hundreds of which change ten times a second. So nothing is compared: the
 * messages name what has changed. And of each variable only a *stretch* is kept for each second in which it changed,
 * which bounds what a minute can take.
 */
import type { StreamMessage, Value, Variable } from '#lib/contract.ts';

/** Seconds that are kept. */
export const WINDOW = 60;
/** Seconds after which it is not known what was in between. */
const TORN = 2;

/** What a variable was from `at` on. Values are places in its domain, and NaN where they were unknown. */
export interface Stretch {
	/** Seconds on the controller's clock. */
	readonly at: number;
	/** The lowest and the highest known value within the second of `at`; NaN where there was none. */
	readonly low: number;
	readonly high: number;
	/** The value with which that second ended, until the next stretch. */
	readonly last: number;
	/** How often it changed within that second, as far as was heard. */
	readonly changes: number;
}

/** From `at` on it was `value`; null where that was not known. */
export interface Earlier {
	readonly at: number;
	readonly value: Value | null;
}

type Kept = { -readonly [Key in keyof Stretch]: Stretch[Key] };

export class Recorder {
	readonly #tracks = new Map<string, Kept[]>();
	#time = -Infinity;

	/** Takes note of a message that was applied. True when the station may have other variables than before. */
	hear(message: StreamMessage): boolean {
		switch (message.kind) {
			case 'snapshot': {
				const { time, variables } = message.view;
				this.#arriveAt(time);
				for (const name of this.#tracks.keys()) if (!Object.hasOwn(variables, name)) this.#tracks.delete(name);
				for (const [name, variable] of Object.entries(variables)) this.#note(name, variable);
				return true;
			}
			case 'delta': {
				const { time, variables } = message.changed;
				if (time !== undefined) this.#arriveAt(time);
				const before = this.#tracks.size;
				for (const [name, variable] of Object.entries(variables ?? {})) this.#note(name, variable);
				const others = this.#tracks.size !== before;
				const gone = message.removed.variables ?? [];
				for (const name of gone) this.#tracks.delete(name);
				return others || gone.length > 0;
			}
			default:
				return false;
		}
	}

	/** What is known of a variable, the oldest first. What lies before the last minute may be among it. */
	of(name: string): readonly Stretch[] {
		return this.#tracks.get(name) ?? [];
	}

	/** Takes note of what was before anything was heard: the values of `variables` by their names, the oldest first. */
	recall(past: ReadonlyMap<string, readonly Earlier[]>, variables: Readonly<Record<string, Variable>>): void {
		for (const [name, earlier] of past) {
			const track = this.#tracks.get(name);
			const oldest = track?.[0];
			const variable = variables[name];
			if (track === undefined || oldest === undefined || variable === undefined) continue;
			const before: Kept[] = [];
			for (const { at, value } of earlier) if (at < oldest.at) extend(before, at, placeOf({ ...variable, value }));
			const last = before.at(-1);
			if (last === undefined) continue;
			if (oldest.changes === 0 && !Object.is(last.last, oldest.last)) oldest.changes = 1;
			track.unshift(...before);
		}
	}

	#arriveAt(time: number): void {
		if (Math.abs(time - this.#time) > TORN) this.#tracks.clear();
		this.#time = time;
	}

	#note(name: string, variable: Variable): void {
		const place = placeOf(variable);
		const since = variable.since ?? this.#time;
		const track = this.#tracks.get(name) ?? [];
		this.#tracks.set(name, track);
		extend(track, Math.max(track.at(-1)?.at ?? -Infinity, since), place);
		while ((track[1]?.at ?? Infinity) < this.#time - WINDOW) track.shift();
	}
}

/** Has a value at the end of what was before. */
function extend(track: Kept[], at: number, place: number): void {
	const newest = track.at(-1);
	if (newest === undefined) track.push({ at, low: place, high: place, last: place, changes: 0 });
	else if (Object.is(newest.last, place)) return;
	else if (Math.floor(at) === Math.floor(newest.at)) {
		newest.low = extreme(newest.low, place, Math.min);
		newest.high = extreme(newest.high, place, Math.max);
		newest.last = place;
		newest.changes += 1;
	} else track.push({ at, low: place, high: place, last: place, changes: 1 });
}

/** The place of a variable's value in its domain. */
function placeOf({ value, domain }: Pick<Variable, 'value' | 'domain'>): number {
	if (value === null) return NaN;
	const [first] = domain;
	// A range of integers may be long, and has no holes.
	return typeof value === 'number' && typeof first === 'number' ? value - first : domain.indexOf(value);
}

/** Of two places the one that `choose` takes; an unknown one counts for nothing. */
function extreme(one: number, other: number, choose: (one: number, other: number) => number): number {
	if (Number.isNaN(one)) return other;
	return Number.isNaN(other) ? one : choose(one, other);
}
