/** The course of a trial: what has been, what is under way, and what did not come. */
import type { Reaction, Trial, TriedReaction } from '#lib/contract.ts';

export type StepName = 'sent' | 'accepted' | 'started' | 'executing' | 'finished' | 'ended';
export type Mark = 'done' | 'now' | 'ahead' | 'never';

export interface Step {
	readonly name: StepName;
	/** Seconds since the epoch; null where it has not been. */
	readonly at: number | null;
	readonly mark: Mark;
}

/** A trial that was sent from here at `sent`; null for one that was not. Its times are of this device's clock. */
export interface Sent {
	readonly at: number;
	/** The trial that was known before. */
	readonly before: number | null;
}

/** Whether the trial is another one than was known before it was sent. */
export function isNew(sent: Sent, trial: Pick<Trial, 'accepted'> | null): boolean {
	return trial !== null && trial.accepted !== sent.before;
}

/** Seconds in which a trial that was sent is accepted or refused. */
const ANSWERED = 10;

/** Whether it is the trial that was sent, and not a later one of somebody else. */
export function belongs(sent: Sent, trial: Pick<Trial, 'accepted'>): boolean {
	return Math.abs(trial.accepted - sent.at) < ANSWERED;
}

/** Its steps in order. Without a `trial` it was sent and not accepted yet. */
export function stepsOf(sent: number | null, trial: Trial | null): Step[] {
	const over = trial !== null && trial.ended !== null;
	const times: [StepName, number | null][] = [
		['accepted', trial?.accepted ?? null],
		['started', trial?.started ?? null],
		['executing', trial?.executing ?? null],
		[over && !trial.done ? 'ended' : 'finished', trial?.ended ?? null]
	];
	const first: Step[] = sent === null ? [] : [{ name: 'sent', at: sent, mark: 'done' }];
	const lastSeen = times.findLastIndex(([, at]) => at !== null);
	let open = !over;
	return [
		...first,
		...times.map(([name, at], place): Step => {
			if (at !== null) return { name, at, mark: 'done' };
			if (over || place < lastSeen) return { name, at, mark: 'never' };
			const mark: Mark = open ? 'now' : 'ahead';
			open = false;
			return { name, at, mark };
		})
	];
}

export type Came = 'came' | 'due' | 'missing' | 'untouched' | 'faultless';

/** Seconds by which what a device does is told late at most: messages come now and then. */
const TOLD_LATE = 1;

/**
 * How a reaction went, at the time `now`. One that could have come and has not within twice the longest time it should
 * take is missing, whether the trial is over or not, unless it is a fault.
 */
export function cameOf(
	{ fault, longest }: Pick<Reaction, 'fault' | 'longest'>,
	tried: TriedReaction | undefined,
	now: number
): Came {
	if (tried !== undefined && tried.came !== null) return 'came';
	if (fault) return 'faultless';
	if (tried === undefined || tried.due === null) return 'untouched';
	return now - tried.due > 2 * longest + TOLD_LATE ? 'missing' : 'due';
}
