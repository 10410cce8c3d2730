/** Where to look after an alarm. */
import type { Alarm, StationView } from '#lib/contract.ts';
import { lacksPlan } from '#lib/restart/shown.ts';

export interface About {
	/** Names of resources. */
	readonly resources: readonly string[];
	/** Topics on which something is to be seen. */
	readonly topics: readonly string[];
	/** Whether what to do is done on the page Restart, also since the state is unsafe or there is no plan because of it. */
	readonly restart: boolean;
}

/** Where to look after `alarm` at a station like this. */
export function aboutOf(
	alarm: Pick<Alarm, 'group' | 'resources' | 'topics'>,
	station: Pick<StationView, 'resources' | 'standing' | 'plan' | 'operations'>
): About {
	return {
		resources: alarm.resources.filter((name) => Object.hasOwn(station.resources, name)),
		topics: alarm.topics,
		restart: alarm.group === 'recovery' || (alarm.group === 'device' && (station.standing === 'stopped' || lacksPlan(station)))
	};
}
