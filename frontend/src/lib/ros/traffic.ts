/**
 * How often topics speak: messages per second over the last seconds, from the counters of the station.
 *
 * Counters are noted once a second. One that went back is of a controller that was started anew: what was noted before it
 * counts no more.
 */
import type { Topic } from '#lib/contract.ts';

/** Seconds over which a rate is told. */
export const OVER = 5;

/** The counters of all topics at one time (seconds, on the controller's clock). */
export interface Note {
	readonly time: number;
	readonly messages: ReadonlyMap<string, number>;
}

/** Notes the counters of `topics` at `time` behind `notes`, and keeps what rates are told from. */
export function noted(notes: readonly Note[], time: number, topics: Readonly<Record<string, Topic>>): Note[] {
	const messages = new Map(Object.entries(topics).map(([name, topic]) => [name, topic.messages]));
	const last = notes.at(-1);
	if (last !== undefined && time === last.time) return [...notes];
	const wentBack = (name: string, count: number): boolean => count < (last?.messages.get(name) ?? 0);
	const anew = last !== undefined && (time < last.time || [...messages].some(([name, count]) => wentBack(name, count)));
	return [...(anew ? [] : notes.filter((note) => note.time > time - OVER - 1)), { time, messages }];
}

/** Messages per second of the topic `name`; null while too little is known. */
export function rateOf(notes: readonly Note[], name: string): number | null {
	const [first, last] = [notes.find((note) => note.messages.has(name)), notes.at(-1)];
	const [from, to] = [first?.messages.get(name), last?.messages.get(name)];
	if (first === undefined || last === undefined || from === undefined || to === undefined) return null;
	return last.time - first.time < 1 ? null : (to - from) / (last.time - first.time);
}

/** A rate with two figures or so: `0.25`, `9.8`, `120`. */
export function rateText(rate: number, locale: string): string {
	const digits = rate === 0 || rate >= 10 ? 0 : rate >= 1 ? 1 : 2;
	return rate.toLocaleString(locale, { minimumFractionDigits: digits, maximumFractionDigits: digits });
}
