/** What has changed at the station since something was looked at. */
import type { StationView, Value } from '#lib/contract.ts';

export interface Change {
	readonly name: string;
	readonly before: Value | null;
	readonly now: Value | null;
}

type Variables = StationView['variables'];

/** The variables with other values than `before`. What did not change is the same object, so this is quick. */
export function changesSince(before: Variables, now: Variables): Change[] {
	return Object.entries(now).flatMap(([name, variable]) => {
		const then = before[name];
		if (then === variable || then?.value === variable.value) return [];
		return [{ name, before: then?.value ?? null, now: variable.value }];
	});
}
