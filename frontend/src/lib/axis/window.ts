/** The part of the time line that is in sight; all are seconds since the epoch. */
export interface Window {
	readonly from: number;
	readonly to: number;
}

/** The shortest part that can be looked at. */
export const SHORTEST = 5;
/** What is first in sight, where nothing else is asked for. */
export const USUAL = 120;

/** `window`, kept within the journal from `first` to `last`, with a little room on both sides. */
export function within(window: Window, first: number, last: number): Window {
	const whole = Math.max(last - first, SHORTEST);
	const length = Math.min(Math.max(window.to - window.from, SHORTEST), whole * 1.04 + 2);
	const room = Math.min(Math.max(whole * 0.02, 1), length / 2);
	const latest = Math.max(last + room - length, first - room);
	const from = Math.min(Math.max(window.from, first - room), latest);
	return { from, to: from + length };
}

/** `window`, `factor` times as long, with the moment `at` where it was. */
export function zoomed({ from, to }: Window, factor: number, at: number): Window {
	const length = Math.max((to - from) * factor, SHORTEST);
	const share = (at - from) / (to - from);
	return { from: at - share * length, to: at + (1 - share) * length };
}

/** `window`, moved by a share of its length. */
export function moved({ from, to }: Window, share: number): Window {
	const by = (to - from) * share;
	return { from: from + by, to: to + by };
}

/** `window` if the moment `at` is well within it, else as long a one with it in the middle. */
export function showing(window: Window, at: number): Window {
	if (at >= window.from && at <= window.to) return window;
	const half = (window.to - window.from) / 2;
	return { from: at - half, to: at + half };
}

/** Where a moment is in the window: 0 at its beginning, 1 at its end. */
export function shareOf({ from, to }: Window, at: number): number {
	return (at - from) / (to - from);
}

/** The moment at a share of the window. */
export function momentAt({ from, to }: Window, share: number): number {
	return from + share * (to - from);
}
