/** Which alarms a tone is for: those of high priority that nobody has acknowledged, when they come. */
import type { Alarms } from './priority.ts';

/** Those that a person must look at, each by its key and when it came. */
export function urgent(alarms: Alarms): ReadonlySet<string> {
	return new Set(
		Object.entries(alarms)
			.filter(([, alarm]) => alarm.priority === 'high' && alarm.state === 'unacknowledged')
			.map(([key, alarm]) => `${alarm.since} ${key}`)
	);
}

/** Whether something is in `now` that was not in `before`; nothing is new to who has seen nothing before. */
export function isNews(before: ReadonlySet<string> | null, now: ReadonlySet<string>): boolean {
	return before !== null && [...now].some((each) => !before.has(each));
}
