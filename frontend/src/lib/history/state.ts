/** Of the variables at a moment of the past: which changed at its record, and in which order they are read. */
import type { RunRecord } from '#lib/contract.ts';
import { partOf } from './told.ts';

/** The variables that have other values since this record. One that says everything says nothing of what changed. */
export function changedAt({ content }: Pick<RunRecord, 'content'>): Set<string> {
	const parts = [partOf(content, 'measured'), partOf(content, 'changes')];
	return new Set(parts.flatMap((part) => Object.keys(part ?? {})));
}

/** `ids` by what they are called. */
export function sortedBy(ids: readonly string[], called: (id: string) => string): string[] {
	return ids
		.map((id) => [called(id), id] as const)
		.sort(([a], [b]) => a.localeCompare(b, undefined, { numeric: true }))
		.map(([, id]) => id);
}
