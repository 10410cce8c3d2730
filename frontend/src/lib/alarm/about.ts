/** Where to look after an alarm. */
import type { Alarm, StationView } from '#lib/contract.ts';

export interface About {
	/** Names of resources. */
	readonly resources: readonly string[];
	/** Topics on which something is to be seen. */
	readonly topics: readonly string[];
	/** Whether what to do is done on the page Restart, also since the state is unsafe because of it. */
	readonly restart: boolean;
}

/** Where to look after `alarm` at a station like this. */
export function aboutOf(
	alarm: Pick<Alarm, 'group' | 'resources' | 'topics'>,
	station: Pick<StationView, 'resources' | 'standing'>
): About {
	return {
		resources: alarm.resources.filter((name) => Object.hasOwn(station.resources, name)),
		topics: alarm.topics,
		restart: alarm.group === 'recovery' || (alarm.group === 'device' && station.standing === 'stopped')
	};
}
