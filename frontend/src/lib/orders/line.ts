/** The order of work over time: what was made, what is in work, and what waits by when it is expected. */
import type { JobOrder, JobResponse } from '#lib/contract.ts';
import { lateBy, titleOf } from './orders.ts';

export interface OrderBar {
	readonly id: string;
	readonly title: string;
	readonly tone: 'past' | 'run' | 'next' | 'plan';
	readonly from: number;
	readonly to: number;
	/** Nobody knows when it will be ready. */
	readonly open: boolean;
	readonly late: boolean;
}

export interface DueMark {
	readonly id: string;
	readonly title: string;
	readonly at: number;
	readonly late: boolean;
}

export interface OrderLine {
	/** By work master, in the order in which they come. */
	readonly lanes: ReadonlyMap<string, readonly OrderBar[]>;
	readonly due: readonly DueMark[];
	/** Orders that may start of which nobody knows when they do. */
	readonly unknown: number;
}

/** The share of a part of the time line from which an order in it is more than a sliver. */
const WIDE = 1 / 40;

/** The longest of these parts of the time line (seconds) in which a usual order is still wide enough. */
export function partFor({ lanes }: Pick<OrderLine, 'lanes'>, parts: readonly number[]): number {
	const lengths = [...lanes.values()].flat().flatMap(({ from, to, open }) => (open ? [] : [to - from])).sort((a, b) => a - b);
	const usual = lengths[Math.floor(lengths.length / 2)] ?? Infinity;
	const fits = parts.filter((part) => usual >= part * WIDE);
	return fits.length > 0 ? Math.max(...fits) : Math.min(...parts);
}

/** What titles say apart from what all of them begin with, in words and parts of numbers: a short bar has room for that. */
export function ownWords(titles: readonly string[]): string[] {
	if (new Set(titles).size < 2) return [...titles];
	const all = titles.map((title) => title.split(/(?<= |· |-)/));
	const fewest = Math.min(...all.map(({ length }) => length));
	let same = 0;
	while (same < fewest - 1 && all.every((words) => words[same] === all[0]?.[same])) same += 1;
	return all.map((words) => words.slice(same).join(''));
}

/** The last part of each title, for bars that have no room for more; all of them where two have the same one. */
export function lastParts(titles: readonly string[]): string[] {
	const last = titles.map((title) => /[^ ·-]*$/.exec(title)?.[0] ?? '');
	return new Set(last).size === new Set(titles).size && last.every(Boolean) ? last : [...titles];
}

/** The line of orders that are not over, in their order, and of what was made. */
export function lineOf(orders: readonly JobOrder[], made: readonly JobResponse[], now: number): OrderLine {
	const lanes = new Map<string, OrderBar[]>();
	const add = (master: string, bar: OrderBar): void => void lanes.set(master, [...(lanes.get(master) ?? []), bar]);
	for (const { job_order, description, work_master, began, ended } of made)
		if (began !== null) {
			const title = titleOf({ description, id: job_order });
			add(work_master, { id: job_order, title, tone: 'past', from: began, to: ended, open: false, late: false });
		}
	let unknown = 0;
	let next = true;
	for (const order of orders) {
		const title = titleOf(order);
		const common = { id: order.id, title, late: lateBy(order, now) > 0 };
		const end = order.expected_end;
		if (order.began !== null) {
			const to = Math.max(end ?? now, now);
			add(order.work_master, { ...common, tone: 'run', from: order.began, to, open: end === null });
		} else if (order.expected_start !== null && end !== null) {
			add(order.work_master, { ...common, tone: next ? 'next' : 'plan', from: Math.max(order.expected_start, now), to: end, open: false });
			next = false;
		} else if (order.state === 'AllowedToStart') unknown += 1;
	}
	const due = orders.flatMap((order) =>
		order.due === null ? [] : [{ id: order.id, title: titleOf(order), at: order.due, late: lateBy(order, now) > 0 }]
	);
	return { lanes, due, unknown };
}
