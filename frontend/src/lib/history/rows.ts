/** The list of what happened: records of the run and acts of people, the newest first. */
import type { AuditRecord, RunRecord } from '#lib/contract.ts';
import { actsOf, type Act } from '#lib/journal/acts.ts';

export type Row =
	| { readonly key: string; readonly time: number; readonly record: RunRecord; readonly act: null }
	| { readonly key: string; readonly time: number; readonly record: null; readonly act: Act };

/** Both in one list. A command comes before its effect, even where they are of the same time. */
export function rowsOf(records: readonly RunRecord[], acts: readonly AuditRecord[]): Row[] {
	const done = actsOf([...acts].sort((a, b) => b.number - a.number));
	const rows: Row[] = [
		...records.map((record) => ({ key: `r${record.number}`, time: record.time, record, act: null })),
		...done.map((act) => ({ key: `a${act.record.number}`, time: act.record.time, record: null, act }))
	];
	return rows.sort((a, b) => b.time - a.time || orderOf(b) - orderOf(a));
}

/** Of records of one time the later has the higher number; acts are before all of them. */
function orderOf(row: Row): number {
	return row.record === null ? 0 : row.record.number;
}

/** What is known after more of it was read: each number once. */
export function joined<Numbered extends { readonly number: number }>(
	known: readonly Numbered[],
	more: readonly Numbered[]
): Numbered[] {
	const numbers = new Set(known.map((each) => each.number));
	return [...known, ...more.filter((each) => !numbers.has(each.number))].sort((a, b) => b.number - a.number);
}
