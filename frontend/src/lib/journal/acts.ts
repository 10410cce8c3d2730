/**
 * From records to acts. A command is recorded before its effect and again when its end is known; a person reads the two
 * as one.
 */
import type { AuditAnswer, AuditRecord, Outcome } from '#lib/contract.ts';

export interface Act {
	/** What was written first. */
	readonly record: AuditRecord;
	/** What was written when the end was known; null where nothing was, or need not be. */
	readonly end: AuditRecord | null;
}

/** The acts in `records` (newest first), newest first. An end without its beginning among them stands for itself. */
export function actsOf(records: readonly AuditRecord[]): Act[] {
	const begun = new Set(records.filter((record) => (record.entry.about ?? null) === null).map((record) => record.number));
	const ends = new Map<number, AuditRecord>();
	const acts: AuditRecord[] = [];
	for (const record of records) {
		const about = record.entry.about ?? null;
		if (about !== null && begun.has(about) && !ends.has(about)) ends.set(about, record);
		else acts.push(record);
	}
	return acts.map((record) => ({ record, end: ends.get(record.number) ?? null }));
}

/** How the act ended, as far as is known. */
export function outcomeOf({ record, end }: Act): Outcome {
	return (end ?? record).entry.outcome;
}

/** What is known after the newest records were read again. */
export function withNewest(known: AuditAnswer | null, newest: AuditAnswer): AuditAnswer {
	if (known === null) return newest;
	const numbers = new Set(known.records.map((record) => record.number));
	// Where the two do not meet there may be records between them: what was known is then read again page by page.
	if (newest.next !== null && !newest.records.some((record) => numbers.has(record.number))) return newest;
	const fresh = newest.records.filter((record) => !numbers.has(record.number));
	return { records: [...fresh, ...known.records], next: known.next };
}

/** What is known after older records were read. */
export function withOlder(known: AuditAnswer, older: AuditAnswer): AuditAnswer {
	return { records: [...known.records, ...older.records], next: older.next };
}
