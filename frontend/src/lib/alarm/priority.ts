/**
 * Alarm priorities and states after ISA-18.2: each priority has a number and a word here, and a shape and a colour of
 * its own where it is drawn.
 */
import type { Alarm, AlarmState, Priority } from '#lib/contract.ts';

export const PRIORITY: Record<Priority, { readonly number: number; readonly word: string }> = {
	high: { number: 1, word: 'High' },
	medium: { number: 2, word: 'Medium' },
	low: { number: 3, word: 'Low' }
};

export const ALARM_STATE: Record<AlarmState, string> = {
	unacknowledged: 'not acknowledged',
	returned: 'over, not acknowledged',
	acknowledged: 'acknowledged',
	shelved: 'shelved',
	'out-of-service': 'out of service'
};

/** Whether it is over or not, nobody has said yet that they have seen it. */
export function isNew(alarm: Alarm): boolean {
	return alarm.state === 'unacknowledged' || alarm.state === 'returned';
}

/** Whether people are told of it at all. */
function isTold(alarm: Alarm): boolean {
	return alarm.state !== 'shelved' && alarm.state !== 'out-of-service';
}

type Alarms = Readonly<Record<string, Alarm>>;

/** Those that people are told of, the most urgent first; of equals those that nobody has seen, then the newest. */
export function byUrgency(alarms: Alarms): [string, Alarm][] {
	return sorted(Object.entries(alarms).filter(([, alarm]) => isTold(alarm)));
}

/** Those that people are not told of, because somebody wanted that. */
export function setAside(alarms: Alarms): [string, Alarm][] {
	return sorted(Object.entries(alarms).filter(([, alarm]) => !isTold(alarm)));
}

function sorted(alarms: [string, Alarm][]): [string, Alarm][] {
	return alarms.sort(
		([, a], [, b]) =>
			PRIORITY[a.priority].number - PRIORITY[b.priority].number ||
			Number(isNew(b)) - Number(isNew(a)) ||
			b.since - a.since
	);
}
