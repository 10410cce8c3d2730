/** When ways back are asked for again: as soon as the station has moved, and calmly. */
import type { AdviceAnswer } from '#lib/contract.ts';

/** What is known of the last question. */
export interface Asked {
	readonly answer: AdviceAnswer | null;
	/** The last question was not answered. */
	readonly refused: boolean;
	/** Answers in a row for the same state. */
	readonly times: number;
	/** Milliseconds since the last answer, or since it did not come. */
	readonly since: number;
}

/** Milliseconds between an answer and the next question, at least. */
const CALM = 2000;
/** Milliseconds after which the same state is asked about again: a device that does nothing more is noticed by time alone. */
const SAME_STATE = 10_000;
/** The same, where the search for ways has not come to its end in as much time as it had: each one takes seconds of the machine. */
const UNFINISHED = 30_000;
/** How often more time is asked for where there was too little. */
const PATIENCE = 3;
/** After so many answers what there is is shown, and the search goes on beside that. */
const ENOUGH = 2;

/**
 * There was too little time, and what was found, if anything, says what nobody may have looked at: whoever looks may see
 * that it is not so.
 */
function wantsMore(answer: AdviceAnswer): boolean {
	return !answer.complete && answer.offers.every(({ corrections }) => corrections.length > 0);
}

/** Whether that is what there is to be said of a state, after as many answers as `times`. */
export function isSettled(answer: AdviceAnswer, times: number): boolean {
	return times >= ENOUGH || !wantsMore(answer);
}

/** Whether it is asked for again by itself soon: after as many answers as `times` not all ways were looked for. */
export function goesOnLooking(answer: AdviceAnswer, times: number): boolean {
	return !answer.complete && times < PATIENCE;
}

/** Whether to ask now, of a station whose state is at `revision`. */
export function isDue({ answer, refused, times, since }: Asked, revision: number): boolean {
	if (since < CALM) return false;
	if (answer === null || refused || answer.revision !== revision) return true;
	// Asked again in the same state it has more time; what it said for good costs it nothing to say again.
	return goesOnLooking(answer, times) || since >= (answer.complete ? SAME_STATE : UNFINISHED);
}
