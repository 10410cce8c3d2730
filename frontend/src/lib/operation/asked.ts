/** What jobs have to do with an operation, while the station works by order. */
import type { StationView } from '#lib/contract.ts';

export interface Asked {
	/** Whether no job asks for it, one will, one does, or one has done. */
	readonly how: 'none' | 'later' | 'now' | 'done';
	/** The title of the job. */
	readonly job: string;
}

/** Null where it becomes active without a job. */
export function askedFor(view: StationView | null, name: string): Asked | null {
	const operation = view?.operations[name];
	if (view === null || operation === undefined || !view.by_order || !operation.for_jobs) return null;
	const job = operation.job === null ? undefined : view.jobs[operation.job];
	if (job === undefined) return { how: 'none', job: '' };
	const state = job.steps[name]?.state;
	const how = state === 'completed' ? 'done' : state === 'eligible' || state === 'active' ? 'now' : 'later';
	return { how, job: job.title };
}
