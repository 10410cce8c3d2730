/** Job orders as they are shown: in which order, what they are called, and what there is to ask of them. */
import type { JobOrder, OrderOfWork, StationView } from '#lib/contract.ts';

/** The states of an order that is not over, those first that the station works on. */
export const OPEN = ['Running', 'Interrupted', 'AllowedToStart', 'NotAllowedToStart'] as const;

/** What an order is called. */
export function titleOf({ description, id }: Pick<JobOrder, 'description' | 'id'>): string {
	return description.trim() || id;
}

/** Each once, as it was last: lists that were read one after the other may have the same one in two states. */
function newest(orders: readonly JobOrder[]): JobOrder[] {
	const known = new Map<string, JobOrder>();
	for (const order of orders) if ((known.get(order.id)?.revision ?? -1) < order.revision) known.set(order.id, order);
	return [...known.values()];
}

/** As they are to begin: what is worked on, then by the order of work that was found, then by priority and time. */
export function inOrder(orders: readonly JobOrder[], found: OrderOfWork | null): JobOrder[] {
	const places = new Map((found?.job_orders ?? []).map(({ id }, place) => [id, place]));
	const last = places.size;
	const of = (order: JobOrder): readonly number[] => [
		OPEN.findIndex((state) => state === order.state),
		places.get(order.id) ?? last,
		-order.priority,
		order.due ?? Infinity,
		order.stored
	];
	return newest(orders).sort((one, other) => {
		const [mine, theirs] = [of(one), of(other)];
		const at = mine.findIndex((each, place) => each !== theirs[place]);
		return at < 0 ? 0 : (mine[at] ?? 0) < (theirs[at] ?? 0) ? -1 : 1;
	});
}

export interface Progress {
	readonly done: number;
	readonly all: number;
	/** The operations that are under way. */
	readonly active: readonly string[];
}

/** How far the station has come with an order; null while it does not work on it. */
export function progressOf(view: StationView | null, id: string): Progress | null {
	const job = view?.jobs[id];
	if (view === null || job === undefined) return null;
	const steps = Object.entries(job.steps).filter(([, { state }]) => state !== 'skipped');
	return {
		done: steps.filter(([, { state }]) => state === 'completed').length,
		all: steps.length,
		active: steps.filter(([, { state }]) => state === 'active').map(([name]) => view.operations[name]?.title ?? name)
	};
}

/** Seconds by which an order is expected to be late; 0 where it is not, or nobody knows. */
export function lateOf(found: OrderOfWork | null, id: string): number {
	return found?.job_orders.find((each) => each.id === id)?.late ?? 0;
}

/** The seconds since the epoch that a field for local date and time means; null where it is empty. */
export function secondsOf(local: string): number | null {
	const time = Date.parse(local);
	return Number.isNaN(time) ? null : time / 1000;
}
