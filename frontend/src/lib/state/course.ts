/**
 * How the value of a variable went, from the records of the journal in which it changed (`docs/journal.md`): measured values,
 * estimates and outputs with every tick, and what people have corrected or forced.
 */
import { arrivals, turnsOf } from '#lib/alarm/record.ts';
import type { Alarm, HistoryAnswer, Moment, Place, RunRecord, Value } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import type { Earlier } from '#lib/stream/recorder.ts';

/** From `at` (seconds) on it was `value`; null where that was not known. */
export interface Change {
	readonly at: number;
	readonly value: Value | null;
	/** What a person did, as in `corrected`; null where the station or a device did it. */
	readonly act: 'corrected' | 'forced' | 'force-released' | null;
}

/** Records of a page, and pages at most: a value may change with every tick. */
const [PAGE, MOST] = [200, 6];
const ACTS: readonly unknown[] = ['corrected', 'forced', 'force-released'] satisfies Change['act'][];
/** Where a record has values by names. */
const PARTS = ['values', 'measured', 'changes'] as const;

function valueIn(part: unknown, name: string): Value | null | undefined {
	if (typeof part !== 'object' || part === null || !Object.hasOwn(part, name)) return undefined;
	return (part as Record<string, Value | null>)[name];
}

/** How a variable changed, the oldest first, from records that are the newest first. */
export function courseOf(records: readonly RunRecord[], name: string): Change[] {
	const found: Change[] = [];
	for (const { time, kind, content } of records.toReversed()) {
		const act = ACTS.includes(kind) ? (kind as Change['act']) : null;
		const own = content['what'];
		const asked = typeof own === 'object' && own !== null && (own as { name?: unknown }).name === name;
		const values = PARTS.map((part) => valueIn(content[part], name)).filter((value) => value !== undefined);
		const last = found.at(-1);
		const value = values.at(-1);
		if (value !== undefined && (last === undefined || last.value !== value || act !== null)) found.push({ at: time, value, act });
		else if (value === undefined && act !== null && asked && last !== undefined) found.push({ at: time, value: last.value, act });
	}
	return found;
}

/** What was so from `from` on: the last change before it stands at its beginning. */
export function since(course: readonly Change[], from: number): Change[] {
	const before = course.findLastIndex(({ at }) => at < from);
	return course.slice(Math.max(0, before));
}

interface Past {
	readonly records: readonly RunRecord[];
	/** Seconds from which on it is known; null where that is all that was asked for. */
	readonly known: number | null;
}

export interface Read {
	readonly course: readonly Change[];
	/** Seconds from which on it is known; null where that is all that was asked for. */
	readonly known: number | null;
}

/** Reads the records that `query` asks for from `from` on, the newest first, as far back as there is not too much. */
async function readBack(query: Readonly<Record<string, string>>, from: number): Promise<Past | Refusal> {
	const records: RunRecord[] = [];
	let before: number | null = null;
	for (let page = 0; page < MOST; page++) {
		const asked = new URLSearchParams({ ...query, limit: String(PAGE) });
		if (before !== null) asked.set('before', String(before));
		const answer = await request<HistoryAnswer>('GET', `/api/v1/history?${asked}`, { patience: 20_000 });
		if (!answer.ok) return answer.refusal;
		records.push(...answer.value.records);
		before = answer.value.next;
		const oldest = records.at(-1)?.time ?? -Infinity;
		if (before === null || oldest < from) return { records, known: null };
	}
	return { records, known: records.at(-1)?.time ?? null };
}

/** Reads how a variable went from `from` on, as far back as there is not too much. */
export async function readCourse(name: string, from: number): Promise<Read | Refusal> {
	const past = await readBack({ name }, from);
	return 'records' in past ? { course: courseOf(past.records, name), known: past.known } : past;
}

/** How all variables changed, by their names: from what they were at `from`, with records that are the newest first. */
export function coursesOf(values: Readonly<Record<string, Value | null>>, from: number, records: readonly RunRecord[]): Map<string, Earlier[]> {
	const found = new Map<string, Earlier[]>(Object.entries(values).map(([name, value]) => [name, [{ at: from, value }]]));
	for (const { time, content } of records.toReversed())
		for (const part of PARTS) {
			const changed = content[part];
			if (time < from || typeof changed !== 'object' || changed === null) continue;
			for (const [name, value] of Object.entries(changed as Record<string, Value | null>)) found.get(name)?.push({ at: time, value });
		}
	return found;
}

/** Reads how all variables went from `from` on; null where that cannot be read, or is too much. */
export async function readCourses(from: number): Promise<Map<string, Earlier[]> | null> {
	const place = await request<Place>('GET', `/api/v1/history/at?time=${from}`, { patience: 20_000 });
	if (!place.ok) return null;
	const [moment, past] = await Promise.all([
		request<Moment>('GET', `/api/v1/history/${place.value.number}`, { patience: 20_000 }),
		readBack({}, place.value.time)
	]);
	if (!moment.ok || !('records' in past) || past.known !== null) return null;
	const begin = Math.max(from, place.value.time);
	return coursesOf(moment.value.past.values, begin, past.records.filter(({ number }) => number > place.value.number));
}

/** An alarm that came. */
export interface AlarmCame {
	readonly at: number;
	readonly alarm: Alarm;
}

/** Reads which alarms of a resource came from `from` on; null where that cannot be read. */
export async function readAlarms(resource: string | null, from: number): Promise<AlarmCame[] | null> {
	if (resource === null) return [];
	const past = await readBack({ kinds: 'alarm' }, from);
	if (!('records' in past)) return null;
	return arrivals(turnsOf(past.records), from)
		.filter(({ alarm }) => alarm.resources?.includes(resource))
		.map(({ time, alarm }) => ({ at: time, alarm }));
}
