/** What the figures of the day come to, for the strip and for the wall. */
import type { Figures } from '#lib/contract.ts';

/** The product in work for which figures are shown: the one that was begun first. */
export function first(figures: Figures | null): Figures['in_work'][number] | undefined {
	return figures?.in_work.toSorted((a, b) => a.began - b.began)[0];
}

/** Which order of today the one in work is; null where nobody can say. */
export function orderOf(figures: Figures | null): { readonly n: number; readonly all: number } | null {
	const made = figures?.made;
	if (!made || made.count === null || made.planned === null) return null;
	return first(figures)?.job && made.count < made.planned ? { n: made.count + 1, all: made.planned } : null;
}

export interface Level {
	/** From 0 to 1. */
	readonly part: number;
	/** Where the mark is. */
	readonly mark: number;
}

/** How much of what is to be made today is made; null where nothing is due. */
export function madeLevel(figures: Figures | null): Level | null {
	const made = figures?.made;
	if (!made || made.count === null || made.planned === null || made.by_now === null || made.planned === 0) return null;
	return { part: made.count / made.planned, mark: made.by_now / made.planned };
}

/** How long this product takes beside how long they do, of which a quarter more still has room. */
export function cycleLevel(seconds: number, median: number): Level {
	const whole = Math.max(seconds, median * 1.25, 1);
	return { part: seconds / whole, mark: median / whole };
}

/** A share as people say it, with a decimal: `94.2`. */
export function percentText(share: number, locale: string): string {
	return (share * 100).toLocaleString(locale, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
}
