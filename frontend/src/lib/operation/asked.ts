/** What jobs have to do with an operation, while the station works by order. */
import type { StationView } from '#lib/contract.ts';

export interface Asked {
	/** Whether no job asks for it, one will, one does, one has done, or one has taken another alternative. */
	readonly how: 'none' | 'later' | 'now' | 'done' | 'skipped';
	/** The title of the job. */
	readonly job: string;
}

const HOW = { waiting: 'later', eligible: 'now', active: 'now', completed: 'done', skipped: 'skipped' } as const;

/** Null where it becomes active without a job. */
export function askedFor(view: StationView | null, name: string): Asked | null {
	const operation = view?.operations[name];
	if (view === null || operation === undefined || !view.by_order || !operation.for_jobs) return null;
	const job = operation.job === null ? undefined : view.jobs[operation.job];
	if (job === undefined) return { how: 'none', job: '' };
	const state = job.steps[name]?.state;
	return { how: HOW[state ?? 'waiting'], job: job.title };
}
