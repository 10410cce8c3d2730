/** Job orders as they are shown: in which order, what they are called, how far they are and how late they are. */
import type { JobOrder, JobOrders, JobResponse, Message, OrderCommand, OrderOfWork, StationView } from '#lib/contract.ts';
import type { OrderCycle } from '#lib/figures/told.ts';
import { groupsOf } from '#lib/operation/groups.ts';
import { told, toldAll, toldHere } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { capital } from '#lib/wording/capital.ts';
import { ageText } from '#lib/wording/time.ts';

/** The states of an order that is not over, those first that the station works on. */
export const OPEN = ['Running', 'Interrupted', 'AllowedToStart', 'NotAllowedToStart'] as const;

/** Where orders stand: a column of the board each. */
export const STANDS = {
	stored: ['NotAllowedToStart'],
	waiting: ['AllowedToStart'],
	worked: ['Running', 'Interrupted']
} as const satisfies Readonly<Record<string, readonly JobOrder['state'][]>>;
export type Stand = keyof typeof STANDS;

/** What is most likely wanted of an order; all else that it allows is in its menu. */
const FIRST: readonly OrderCommand[] = ['Start', 'Resume', 'Pause'];

/** A number that the server has drawn by lot says nothing to people; its end tells orders of one description apart. */
const DRAWN = /^[0-9a-f]{16}$/;
const SHOWN_OF_DRAWN = 4;

export interface OrderName {
	/** The number of the order, or what it is described as where nobody has given it a number. */
	readonly name: string;
	/** The end of a number that was drawn; empty where it is the name. */
	readonly mark: string;
	/** What else is said of it. */
	readonly said: string;
}

/** What stands on the card of an order. */
export function nameOf({ description, id }: Pick<JobOrder, 'description' | 'id'>): OrderName {
	const said = description.trim();
	if (!DRAWN.test(id)) return { name: id, mark: '', said: said === id ? '' : said };
	const mark = id.slice(-SHOWN_OF_DRAWN);
	return said ? { name: said, mark, said: '' } : { name: mark, mark: '', said: '' };
}

/** What an order is called in a sentence; the station calls its job the same. */
export function titleOf(order: Pick<JobOrder, 'description' | 'id'>): string {
	const { name, mark } = nameOf(order);
	return mark ? `${name} · ${mark}` : name;
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

/** Those of a column, in their order. */
export function standing(orders: readonly JobOrder[], stand: Stand): JobOrder[] {
	return orders.filter(({ state }) => STANDS[stand].some((each) => each === state));
}

/** That an order waits for an operation says less than until when that waits; null of all else. */
function conditionOf({ id, arguments: given }: Message): string | null {
	const condition = given?.['condition'];
	if (id !== 'waits.precondition' || condition === undefined) return null;
	return toldHere({ id: 'sentence.until', arguments: { conditions: condition } });
}

type Waiting = Pick<JobOrder, 'waits_for' | 'waits_for_messages' | 'sentence'>;

/**
 * What an order waits for, as a sentence; empty where that is nothing, or only the time before which it may not begin. In short
 * it is the first that is said, and how many there are besides.
 */
export function waitsText({ waits_for: reasons, waits_for_messages: messages, sentence }: Waiting, short = false): string {
	const others = (_: unknown, place: number): boolean => messages[place]?.id !== 'order-waits.earliest';
	const all = toldAll(messages.filter(others), reasons.filter(others));
	const [first] = all;
	if (first === undefined) return '';
	if (short) {
		const [brief, ...more] = [...new Set(messages.length === reasons.length ? messages.filter(others).map(conditionOf) : [])];
		if (brief) return `${capital(brief)}${more.length > 0 ? ` +${String(more.length)}` : ''}`;
		if (all.length > 1) return `${say().orders.waits(first)} +${String(all.length - 1)}`;
	}
	return capital(told(sentence, say().orders.waits(all.join('; '))));
}

/** The act that stands on the card, and those in its menu. */
export function actsOf({ allowed }: Pick<JobOrder, 'allowed'>): { first: OrderCommand | null; rest: readonly OrderCommand[] } {
	const first = FIRST.find((each) => allowed.includes(each)) ?? null;
	return { first, rest: allowed.filter((each) => each !== first) };
}

/** Of so many it is drawn how long they took. */
const CYCLES = 16;

/** How long those of a work master took that were made, from the oldest to the newest. */
export function cyclesOf(responses: readonly JobResponse[], master: string): OrderCycle[] {
	return responses
		.flatMap(({ job_order: id, description, work_master, outcome, began, ended }) =>
			work_master === master && outcome === 'completed' && began !== null ? [{ id, title: titleOf({ description, id }), ended, seconds: ended - began }] : []
		)
		.sort((one, other) => one.ended - other.ended)
		.slice(-CYCLES);
}

export interface Progress {
	readonly done: number;
	readonly all: number;
	/** The operations that are under way. */
	readonly active: readonly string[];
}

/** How far the station has come with an order; null while it does not work on it. */
export function progressOf(view: StationView | null, id: string, plural?: (word: string) => string): Progress | null {
	const job = view?.jobs[id];
	if (view === null || job === undefined) return null;
	const steps = Object.entries(job.steps).filter(([, { state }]) => state !== 'skipped');
	return {
		done: steps.filter(([, { state }]) => state === 'completed').length,
		all: steps.length,
		active: activeIn(view, steps.filter(([, { state }]) => state === 'active').map(([name]) => name), plural)
	};
}

/** The titles of operations; of those that differ in a parameter alone one for all. */
function activeIn({ operations }: StationView, names: readonly string[], plural?: (word: string) => string): string[] {
	const known = names.flatMap((name) => (operations[name] ? [[name, operations[name]] as const] : []));
	return [...groupsOf(Object.fromEntries(known), plural).map(({ title }) => title), ...names.filter((name) => !operations[name])];
}

/** Seconds by which an order is late, or expected to be; 0 where it is not, or nobody knows. */
export function lateBy({ due, expected_end }: Pick<JobOrder, 'due' | 'expected_end'>, now: number): number {
	return due === null ? 0 : Math.max(0, Math.max(expected_end ?? now, now) - due);
}

/** Seconds up to which minutes say how late it is. */
const HOURS = 7200;
const MINUTE = 60;

/** By how much it is late, in whole minutes; empty where it is not. */
export function lateText(seconds: number): string {
	if (seconds < 1) return '';
	if (seconds < MINUTE) return say().orders.lateAtMost(say().common.time.min(1));
	return say().orders.late(seconds < HOURS ? say().common.time.min(Math.floor(seconds / MINUTE)) : ageText(seconds * 1000));
}

/** An order that is over: made, put aside, or taken away before it began. */
export interface OverOrder {
	readonly id: string;
	readonly description: string;
	readonly work_master: string;
	readonly outcome: JobResponse['outcome'] | 'cancelled';
	readonly began: number | null;
	readonly ended: number;
	readonly due: number | null;
	readonly reason: string | null;
	/** What was made of it; null of one that was taken away. */
	readonly response: JobResponse | null;
}

/** Those that are over, the last one first. */
export function overOf(responses: readonly JobResponse[], cancelled: JobOrders['job_orders']): OverOrder[] {
	const made = responses.map((response): OverOrder => ({ ...response, id: response.job_order, response }));
	const gone = cancelled.map((order): OverOrder => ({ ...order, outcome: 'cancelled', ended: order.changed, response: null }));
	return [...made, ...gone].sort((one, other) => other.ended - one.ended);
}

/** By how many seconds one that was completed was late. */
export function wasLateBy({ outcome, due, ended }: OverOrder): number {
	return due === null || outcome !== 'completed' ? 0 : Math.max(0, ended - due);
}

/** The orders as they are told while the station does not go on: when one begins or is ready nobody knows then. */
export function untimed(orders: readonly JobOrder[]): JobOrder[] {
	return orders.map((order) => ({ ...order, expected_start: null, expected_end: null }));
}

/** When all of them are expected to be ready; null where that is not known of each, or there are none. */
export function lastEnd(orders: readonly Pick<JobOrder, 'expected_end'>[]): number | null {
	const ends = orders.map(({ expected_end }) => expected_end);
	return ends.length > 0 && ends.every((each) => each !== null) ? Math.max(...ends) : null;
}

/** Whether something was on the day of `now`, on this device. */
export function isOfDay(moment: number, now: number): boolean {
	return new Date(moment * 1000).toDateString() === new Date(now * 1000).toDateString();
}

/** The seconds since the epoch that a field for local date and time means; null where it is empty. */
export function secondsOf(local: string): number | null {
	const time = Date.parse(local);
	return Number.isNaN(time) ? null : time / 1000;
}
