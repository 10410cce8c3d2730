/**
 * Alarm priorities and states after ISA-18.2: each priority has a number here, a word in the catalogue, and a shape and a
 * colour of its own where it is drawn.
 */
import type { Alarm, AlarmState, Priority } from '#lib/contract.ts';

/** The number of a priority; 1 is the most urgent. */
export const NUMBER: Record<Priority, number> = { high: 1, medium: 2, low: 3 };

/** All priorities, the most urgent first. */
export const PRIORITIES: readonly Priority[] = ['high', 'medium', 'low'];

/** All states: of alarms that people are told of, then of those that are set aside. */
export const STATES: readonly AlarmState[] = ['unacknowledged', 'returned', 'acknowledged', 'shelved', 'out-of-service'];

/** Whether it is over or not, nobody has said yet that they have seen it. */
export function isNew(alarm: Alarm): boolean {
	return alarm.state === 'unacknowledged' || alarm.state === 'returned';
}

/** Whether people are told of it at all. */
export function isTold(alarm: Alarm): boolean {
	return alarm.state !== 'shelved' && alarm.state !== 'out-of-service';
}

export type Alarms = Readonly<Record<string, Alarm>>;
/** An alarm with its key. */
export type Keyed = [key: string, alarm: Alarm];

/** Whether its cause is over, and it is only left to be seen. */
export function isOver(alarm: Alarm): boolean {
	return alarm.ended !== null;
}

/** Those that people are told of, the most urgent first and what is over last; of equals what nobody has seen, then the newest. */
export function byUrgency(alarms: Alarms): Keyed[] {
	return sorted(Object.entries(alarms).filter(([, alarm]) => isTold(alarm)));
}

/** Those that people are not told of, because somebody wanted that. */
export function setAside(alarms: Alarms): Keyed[] {
	return sorted(Object.entries(alarms).filter(([, alarm]) => !isTold(alarm)));
}

function sorted(alarms: Keyed[]): Keyed[] {
	return alarms.sort(
		([, a], [, b]) =>
			Number(isOver(a)) - Number(isOver(b)) ||
			NUMBER[a.priority] - NUMBER[b.priority] || Number(isNew(b)) - Number(isNew(a)) || b.since - a.since
	);
}
