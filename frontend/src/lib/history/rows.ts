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

/** What was read of one of both, the newest first: `next` is the number before which there is more. */
export interface Read<Numbered extends { readonly number: number; readonly time: number }> {
	readonly all: readonly Numbered[];
	readonly next: number | null;
	readonly more: boolean;
}

export const UNREAD = { all: [], next: null, more: true } as const;
/** Nothing of it is wanted. */
export const NOTHING = { all: [], next: null, more: false } as const;

/** A page as it was read. */
export function readOf<Numbered extends { readonly number: number; readonly time: number }>(page: {
	readonly records: readonly Numbered[];
	readonly next: number | null;
}): Read<Numbered> {
	return { all: page.records, next: page.next, more: page.next !== null };
}

/** The time down to which all of it is known: of what is older there may be more. */
export function boundOf({ all, more }: Read<{ readonly number: number; readonly time: number }>): number {
	return more ? (all.at(-1)?.time ?? Infinity) : -Infinity;
}

/** Whether the newest page and what was read before leave no gap between them. */
export function meets<Numbered extends { readonly number: number; readonly time: number }>(
	known: Read<Numbered>,
	newest: Read<Numbered>
): boolean {
	const numbers = new Set(known.all.map((each) => each.number));
	return !newest.more || newest.all.some((each) => numbers.has(each.number));
}
