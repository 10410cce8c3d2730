/**
 * How old is what the page shows?
 *
 * The time at which a message *arrives* says little: after a pause in the network, or of the server, old messages
 * arrive in one burst. The document carries the controller's own time, so the page compares the two clocks. The
 * smallest difference between arrival and controller's time that was seen is the one with the least delay in it;
 * whatever exceeds it is delay.
 *
 * The differences are kept as one minimum for each second in which something was heard, and only the last thirty of
 * those. Seconds of silence do not count, so that a burst after a long silence cannot pass for fresh; and a
 * controller whose clock was set back counts as old for thirty seconds at most, never as new.
 *
 * All times here are milliseconds; `arrival` and `now` are on this page's monotonic clock.
 */

const SECONDS_KEPT = 30;

interface Minimum {
	readonly second: number;
	readonly difference: number;
}

export interface Hearing {
	readonly minima: readonly Minimum[];
	/** The controller's time in the last document heard. */
	readonly last: number | null;
	/**
	 * That time was seen to move, here or by the server. A first document alone may be what a controller left behind that is
	 * long dead.
	 */
	readonly proven: boolean;
}

export const SILENCE: Hearing = { minima: [], last: null, proven: false };

/**
 * What is known of the clocks after a document of the controller's time `time` arrived. `age` is how long the server had it
 * by then, where it saw that time move.
 */
export function hear(hearing: Hearing, arrival: number, time: number, age: number | null = null): Hearing {
	const second = Math.floor(arrival / 1000);
	const difference = arrival - (age ?? 0) - time;
	const proven = hearing.proven || age !== null || (hearing.last !== null && hearing.last !== time);
	const newest = hearing.minima.at(-1);
	if (newest?.second !== second)
		return { minima: [...hearing.minima, { second, difference }].slice(-SECONDS_KEPT), last: time, proven };
	const least = { second, difference: Math.min(newest.difference, difference) };
	return { minima: [...hearing.minima.slice(0, -1), least], last: time, proven };
}

/** How long the server had what a message shows, in milliseconds, where it says so. */
export function serverAge(message: { readonly age: number | null }): number | null {
	return message.age === null ? null : message.age * 1000;
}

/** This page's clock minus the controller's, as well as is known; null before anything was heard. */
export function clockDifference(hearing: Hearing): number | null {
	if (hearing.minima.length === 0) return null;
	return Math.min(...hearing.minima.map((minimum) => minimum.difference));
}

/** Age of the last document; never less than the time since it arrived. Null before anything was heard. */
export function ageOf(hearing: Hearing, now: number): number | null {
	const difference = clockDifference(hearing);
	if (difference === null || hearing.last === null) return null;
	return Math.max(0, now - difference - hearing.last);
}
