/**
 * Alarm priorities after ISA-18.2: each has a number and a word here, and a shape and a colour of its own where it
 * is drawn.
 */
import type { Alarm, Priority } from '#lib/contract.ts';

export const PRIORITY: Record<Priority, { readonly number: number; readonly word: string }> = {
	high: { number: 1, word: 'High' },
	medium: { number: 2, word: 'Medium' },
	low: { number: 3, word: 'Low' }
};

/** The most urgent first; of equals, the newest first. */
export function byUrgency(alarms: Readonly<Record<string, Alarm>>): [string, Alarm][] {
	return Object.entries(alarms).sort(
		([, a], [, b]) => PRIORITY[a.priority].number - PRIORITY[b.priority].number || b.since - a.since
	);
}
