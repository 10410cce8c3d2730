/**
 * What the journal keeps of alarms: one record for each turn in the life of an alarm, with the alarm as it was then
 * (kind `alarm`, `docs/journal.md`).
 */
import type { Alarm, HistoryAnswer, RunRecord } from '#lib/contract.ts';

/** A turn in the life of an alarm. */
export interface Turn {
	/** Of its record. */
	readonly number: number;
	readonly time: number;
	/** Of the alarm. */
	readonly key: string;
	/** What happened, as in `came`. */
	readonly event: string;
	readonly alarm: Alarm;
}

const CAME = new Set(['came', 'came again']);
/** With these an alarm whose cause is away is gone. */
const PAST = new Set(['ended', 'acknowledged', 'unshelved', 'put back in service', 'is shelved no longer']);

/** The turns in `records`, in their order; a record of another form is passed over. */
export function turnsOf(records: readonly RunRecord[]): Turn[] {
	return records.flatMap(({ number, time, content }) => {
		const { alarm: key, event, ...alarm } = content as unknown as Alarm & { alarm: unknown; event: unknown };
		if (typeof key !== 'string' || typeof event !== 'string' || typeof alarm.text !== 'string') return [];
		return [{ number, time, key, event, alarm }];
	});
}

/** Those with which an alarm was over, and of which nobody has to take note any more; what ended last comes first. */
export function past(turns: readonly Turn[]): Turn[] {
	const over = turns.filter(({ event, alarm }) => PAST.has(event) && alarm.ended !== null);
	return over.sort((one, other) => (other.alarm.ended ?? 0) - (one.alarm.ended ?? 0));
}

/** Those with which an alarm came, not before `from`. */
export function arrivals(turns: readonly Turn[], from: number): Turn[] {
	return turns.filter(({ event, time }) => CAME.has(event) && time >= from);
}

/** The alarms that came most often, each as it was last, with how often; the most frequent first, `most` at most. */
export function frequent(came: readonly Turn[], most: number): [last: Turn, times: number][] {
	const times = new Map<string, [last: Turn, times: number]>();
	for (const turn of came) {
		const before = times.get(turn.key);
		if (before) before[1] += 1;
		else times.set(turn.key, [turn, 1]);
	}
	return [...times.values()].sort(([, a], [, b]) => b - a).slice(0, most);
}

/** How many of `came` there were in each of `n` spans of `seconds`, of which the last one ends at `end`; the oldest first. */
export function perSpan(came: readonly Turn[], end: number, seconds: number, n: number): { readonly at: number; readonly count: number }[] {
	return Array.from({ length: n }, (_, place) => {
		const at = end - (n - place) * seconds;
		return { at, count: came.filter(({ time }) => time >= at && time < at + seconds).length };
	});
}

/** Whether all records since `from` are known. */
export function reachesTo(known: HistoryAnswer, from: number): boolean {
	const oldest = known.records.at(-1);
	return known.next === null || (oldest !== undefined && oldest.time < from);
}

/** What is known after the newest records were read again. */
export function withNewest(known: HistoryAnswer | null, newest: HistoryAnswer): HistoryAnswer {
	if (known === null) return newest;
	const last = known.records[0]?.number ?? 0;
	const fresh = newest.records.filter((record) => record.number > last);
	// Where the two do not meet there may be records between them: what was known is then read again.
	if (newest.next !== null && fresh.length === newest.records.length) return newest;
	return fresh.length === 0 ? known : { records: [...fresh, ...known.records], next: known.next };
}

/** What is known after older records were read. */
export function withOlder(known: HistoryAnswer, older: HistoryAnswer): HistoryAnswer {
	return { records: [...known.records, ...older.records], next: older.next };
}
