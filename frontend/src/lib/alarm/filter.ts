/** Which alarms a person wants to see, as it stands in the address of the page. */
import type { AlarmState, Priority } from '#lib/contract.ts';
import type { About } from './about.ts';
import { PRIORITIES, STATES, type Keyed } from './priority.ts';

export interface Filter {
	/** Null for all, here and below. */
	readonly state: AlarmState | null;
	readonly priority: Priority | null;
	readonly resource: string | null;
}

/** What the query of an address asks for; what it cannot mean is left out. */
export function filterOf(query: Pick<URLSearchParams, 'get'>): Filter {
	return {
		state: STATES.find((state) => state === query.get('state')) ?? null,
		priority: PRIORITIES.find((priority) => priority === query.get('priority')) ?? null,
		resource: query.get('resource') || null
	};
}

/** The query that asks for it, with its question mark; empty for everything. */
export function queryOf(filter: Filter): string {
	const query = new URLSearchParams();
	for (const [name, value] of Object.entries(filter)) if (value !== null) query.set(name, value);
	return query.size === 0 ? '' : `?${query}`;
}

/** Whether an alarm is asked for. */
export function passes({ state, priority, resource }: Filter, [, alarm]: Keyed, about: About): boolean {
	return (
		(state === null || alarm.state === state) &&
		(priority === null || alarm.priority === priority) &&
		(resource === null || about.resources.includes(resource))
	);
}
