/** How many operations are done. */
import type { StationView } from '#lib/contract.ts';
import type { OperationStanding } from './standing.ts';

/** Those of the order in work, as Orders counts them; else all that stand here. */
export function countOf({ by_order: byOrder, jobs }: StationView, standings: ReadonlyMap<string, OperationStanding>): { readonly done: number; readonly all: number } {
	const [job, ...others] = Object.values(jobs).filter(({ state }) => state === 'running' || state === 'paused' || state === 'waiting');
	if (byOrder && job && others.length === 0) {
		const states = Object.values(job.steps).map(({ state }) => state).filter((state) => state !== 'skipped');
		return { done: states.filter((state) => state === 'completed').length, all: states.length };
	}
	const all = [...standings.values()];
	return { done: all.filter((standing) => standing === 'done').length, all: all.length };
}
