/** The moments of a recording as marks on a line, and how its times are said. */
import type { RecordedMoment } from '#lib/contract.ts';
import { durationText } from '#lib/wording/time.ts';

/** Marks closer than this share of the line would lie on each other. */
const APART = 0.002;

export interface Track {
	readonly resource: string;
	/** Where something of it changed, as shares of the line. */
	readonly marks: readonly number[];
}

/** The part of a recording that is shown. */
export interface Span {
	readonly from: number;
	readonly to: number;
}

/** So many seconds after the beginning, as a clock shows it: `1:02.350`. */
export function momentText(seconds: number): string {
	const thousandths = Math.round(seconds * 1000);
	return `${durationText(Math.floor(thousandths / 1000))}.${String(thousandths % 1000).padStart(3, '0')}`;
}

/** The moment that is looked at `at` so many seconds: the last by then; -1 before the first. */
export function indexAt(moments: readonly RecordedMoment[], at: number): number {
	let [low, high] = [0, moments.length];
	while (low < high) {
		const middle = (low + high) >> 1;
		if ((moments[middle]?.at ?? Infinity) <= at) low = middle + 1;
		else high = middle;
	}
	return low - 1;
}

/** The moment that is next to so many seconds; -1 where there is none. */
export function nearest(moments: readonly RecordedMoment[], at: number): number {
	const before = indexAt(moments, at);
	const [one, other] = [moments[before], moments[before + 1]];
	if (other === undefined) return before;
	return one === undefined || other.at - at < at - one.at ? before + 1 : before;
}

/** Where something of each resource changed, in the order in which they first did. */
export function tracksOf(moments: readonly RecordedMoment[], { from, to }: Span, resourceOf: (variable: string) => string): Track[] {
	const found = new Map<string, number[]>();
	const length = Math.max(to - from, 1e-9);
	for (const { at, changes } of moments) {
		const share = (at - from) / length;
		for (const resource of new Set(changes.map(({ name }) => resourceOf(name)))) {
			const marks = found.get(resource) ?? [];
			found.set(resource, marks);
			const last = marks.at(-1);
			if (last === undefined || share - last > APART) marks.push(share);
		}
	}
	return [...found].map(([resource, marks]) => ({ resource, marks }));
}
