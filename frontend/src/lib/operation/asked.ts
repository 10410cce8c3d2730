/** What jobs have to do with an operation, while the station works by order. */
import type { StationView } from '#lib/contract.ts';

export interface Asked {
	/** Whether no job asks for it, one will, one does, one that is paused has it, one has done, or one has taken another alternative. */
	readonly how: 'none' | 'later' | 'now' | 'paused' | 'done' | 'skipped';
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
	const how = HOW[job.steps[name]?.state ?? 'waiting'];
	return { how: job.state === 'paused' && (how === 'later' || how === 'now') ? 'paused' : how, job: job.title };
}

/** Whether it has to be told whose it is: of one order under way all is for that one. */
export function severalOrders({ jobs }: Pick<StationView, 'jobs'>): boolean {
	return Object.values(jobs).filter(({ ended }) => ended === null).length > 1;
}
