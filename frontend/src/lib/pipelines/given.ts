/** What is given to a pipeline that is tried: a message, records by alias, or variables, written as JSON. */
import type { DraftPipeline, Json, TypeOfField } from '#lib/contract.ts';

type Types = Readonly<Record<string, TypeOfField>>;

/** Deeper than this a message is not written out. */
const DEEPEST = 6;

/** What a value of that type may be at first. */
function beginningOf(type: string, types: Types, depth = 0): Json {
	const known = types[type];
	if (!known || depth > DEEPEST) return null;
	switch (known.kind) {
		case 'bool':
			return false;
		case 'enumeration':
			return known.values?.[0] ?? null;
		case 'integer':
			return Math.max(0, known.least ?? 0);
		case 'real':
			return 0;
		case 'text':
			return '';
		case 'list': {
			const { element, length } = known;
			return element === null || length === null ? [] : Array.from({ length }, () => beginningOf(element, types, depth + 1));
		}
		case 'message':
			return Object.fromEntries(
				Object.entries(known.fields ?? {}).map(([name, each]) => [name, beginningOf(each, types, depth + 1)])
			);
	}
}

/** A record of which fields are named by their paths, as a message has it: `{a.b: 1}` is `{a: {b: 1}}`. */
export function nested(record: Readonly<Record<string, Json>>): Record<string, Json> {
	const whole: Record<string, Json> = {};
	for (const [name, value] of Object.entries(record)) {
		// What is below a list is in the list.
		if (name.includes('[')) continue;
		const steps = name.split('.');
		let at = whole;
		for (const step of steps.slice(0, -1)) at = (at[step] ??= {}) as Record<string, Json>;
		const last = steps.at(-1) ?? name;
		if (!Object.hasOwn(at, last)) at[last] = value;
	}
	return whole;
}

/** What may be tried first: all fields with a value of their type. */
export function begunWith({ edges, first, role }: DraftPipeline, types: Types): string {
	const fields = edges[0]?.fields ?? {};
	const names = role === 'outgoing' ? first.filter(({ sent }) => sent).map(({ field }) => field) : Object.keys(fields);
	const record = Object.fromEntries(names.map((name) => [name, beginningOf(fields[name] ?? '', types)]));
	return JSON.stringify(nested(record), null, 2);
}

/** What is written; null where it is no JSON object. */
export function readGiven(text: string): object | null {
	try {
		const value: unknown = JSON.parse(text.trim() === '' ? '{}' : text);
		return typeof value === 'object' && value !== null && !Array.isArray(value) ? value : null;
	} catch {
		return null;
	}
}
