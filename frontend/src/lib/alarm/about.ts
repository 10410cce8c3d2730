/** Where to look after an alarm. */
import type { Alarm, StationView } from '#lib/contract.ts';
import { lacksPlan } from '#lib/restart/shown.ts';

export interface About {
	/** Names of resources. */
	readonly resources: readonly string[];
	/** Topics on which something is to be seen. */
	readonly topics: readonly string[];
	/** Whether what to do is done on the page Restart, as wherever a device is not as it should be. */
	readonly restart: boolean;
}

/** Where to look after `alarm` at a station like this. */
export function aboutOf(
	alarm: Pick<Alarm, 'group' | 'resources' | 'topics' | 'ended' | 'priority'>,
	station: Pick<StationView, 'resources' | 'standing' | 'plan' | 'operations'>
): About {
	const lasts = alarm.ended === null && alarm.priority !== 'low';
	return {
		resources: alarm.resources.filter((name) => Object.hasOwn(station.resources, name)),
		topics: alarm.topics,
		restart: alarm.group === 'recovery' || (alarm.group === 'device' && (lasts || station.standing === 'stopped' || lacksPlan(station)))
	};
}
