/** Notices: alarms that nobody has to acknowledge. */
import type { Alarm, AlarmState } from '#lib/contract.ts';

/** Whether it tells something that nobody has to acknowledge. */
export function isNotice(alarm: Pick<Alarm, 'priority' | 'state' | 'by'>): boolean {
	return alarm.priority === 'low' && alarm.state === 'acknowledged' && alarm.by === null;
}

/** Its state as people are told it. */
export function saidState(alarm: Pick<Alarm, 'priority' | 'state' | 'by'>): AlarmState | 'notice' {
	return isNotice(alarm) ? 'notice' : alarm.state;
}
