/** The order in which operations are listed. */
import type { Operation } from '#lib/contract.ts';

/** Active ones first, the one that has been active longest on top; the rest as the model declares them. */
export function inOrder(operations: Readonly<Record<string, Operation>>): [string, Operation][] {
	const entries = Object.entries(operations);
	const active = entries.filter(([, operation]) => operation.active);
	active.sort(([, a], [, b]) => (a.active_since ?? 0) - (b.active_since ?? 0));
	return [...active, ...entries.filter(([, operation]) => !operation.active)];
}
