/**
 * The plan as a picture over time: one lane per resource, the present where it always is.
 *
 * What has begun is drawn from its start to its end, or to the present; what runs goes on to where it is expected to end,
 * and what is ahead lies after the present by what is expected of it. Times are seconds after the present. A block is as
 * wide as its words need where nothing else needs the room, and never narrower than its mark.
 */
import type { PlanStep } from '#lib/contract.ts';

/** So many times what is in sight is the axis long at most, whatever is expected of the plan. */
export const MOST_SPANS = 10;

/** So many marks has the axis at most. */
export const MOST_MARKS = 36;

export interface Block {
	readonly step: PlanStep;
	/** Where it is drawn with its words: this covers the time it takes. */
	readonly from: number;
	readonly to: number;
	/** Until when it takes time. */
	readonly until: number;
	/** Row within the lane, from 0: blocks of one row never overlap. */
	readonly row: number;
}

export interface Lane {
	readonly resource: string;
	readonly rows: number;
	readonly blocks: readonly Block[];
}

/** Widths in seconds: what words need at best, and what a mark needs. */
export interface Room {
	readonly words: number;
	readonly mark: number;
}

interface Drawn extends Block {
	to: number;
}

/** Whether a step has been started. */
export function hasBegun(step: PlanStep): step is PlanStep & { readonly started: number } {
	return step.started !== null;
}

/** By how much all that is ahead comes later than expected, as its first step should have begun by `now`. */
export function lateness(steps: readonly PlanStep[], now: number): number {
	const first = steps.find((step) => !hasBegun(step));
	return Math.max(0, now - (first?.expected_start ?? now));
}

/** When a step starts and ends, in seconds after `now`; what is ahead comes `late`.. */
export function timesOf(step: PlanStep, now: number, late: number): { start: number; end: number } {
	if (hasBegun(step)) {
		const end = step.ended === null ? Math.max(0, (step.expected_end ?? now) - now) : step.ended - now;
		return { start: step.started - now, end };
	}
	const start = Math.max(0, (step.expected_start ?? now) + late - now);
	return { start, end: start + Math.max(0, (step.expected_end ?? now) - (step.expected_start ?? now)) };
}

/**
 * Lays out the steps of a plan at `now`: those that have begun, then those ahead in the order of their start. There is a
 * lane for each of `resources`, and for those that a step names.
 */
export function layOut(all: readonly PlanStep[], resources: readonly string[], now: number, room: Room): Lane[] {
	const late = lateness(all, now);
	const lanes = new Map<string, PlanStep[]>(resources.map((resource) => [resource, []]));
	for (const step of all) {
		const lane = lanes.get(step.resource);
		if (lane === undefined) lanes.set(step.resource, [step]);
		else lane.push(step);
	}
	return [...lanes].map(([resource, steps]) => {
		const rows = pack(steps, now, late, room);
		return { resource, rows: Math.max(1, rows.length), blocks: rows.flat() };
	});
}

/** The lanes without what begins after `limit`, and the rest of them cut there; how many blocks are not drawn. */
export function cutAt(lanes: readonly Lane[], limit: number): { lanes: Lane[]; later: number } {
	let later = 0;
	const cut = lanes.map((lane) => {
		const blocks = lane.blocks.filter((block) => block.from < limit);
		later += lane.blocks.length - blocks.length;
		return { ...lane, blocks: blocks.map((block) => ({ ...block, to: Math.min(block.to, limit), until: Math.min(block.until, limit) })) };
	});
	return { lanes: cut, later };
}

/** The last moment, in seconds after `now`, at which something is drawn. */
export function endOf(lanes: readonly Lane[]): number {
	return Math.max(0, ...lanes.flatMap((lane) => lane.blocks.map((block) => block.to)));
}

/**
 * The seconds of an axis on which all of a plan that nobody follows yet is in sight, also the words of what begins last:
 * those need what lies after `words`, a share of the axis.
 */
export function lengthAhead(steps: readonly PlanStep[], words: number): number {
	const starts = steps.map((step) => (step.expected_start ?? 0) / Math.max(words, 0.5));
	return Math.max(1, ...starts, ...steps.map((step) => (step.expected_end ?? 0) * 1.04));
}

function pack(steps: readonly PlanStep[], now: number, late: number, room: Room): Drawn[][] {
	const rows: Drawn[][] = [];
	const timed = steps.map((step) => ({ step, ...timesOf(step, now, late) }));
	const begun = timed.filter(({ step }) => hasBegun(step)).sort((a, b) => a.start - b.start);
	const ahead = timed.filter(({ step }) => !hasBegun(step));
	for (const { step, start, end } of begun) {
		// What has begun does not reach over the present for the sake of its words.
		const from = Math.min(start, -room.mark);
		const until = step.ended === null ? Math.max(0, end) : Math.min(0, end);
		place(rows, step, from, until, Math.max(until, Math.min(from + room.words, 0)), room);
	}
	for (const { step, start, end } of ahead)
		place(rows, step, start, end, Math.max(end, start + room.words), room, true);
	return rows;
}

/** Puts a block into the first row with room for it; what stands before it gives up what only its words need. */
function place(rows: Drawn[][], step: PlanStep, from: number, until: number, to: number, room: Room, movable = false): void {
	const last = (row: Drawn[]): Drawn | undefined => row.at(-1);
	const free = (row: Drawn[]): boolean => (last(row)?.to ?? -Infinity) <= from;
	const over = (row: Drawn[]): boolean => (last(row)?.until ?? -Infinity) <= from;
	const cut = (row: Drawn[]): boolean => over(row) && (last(row)?.from ?? -Infinity) + room.mark <= from;
	let index = rows.findIndex(free);
	if (index === -1) index = rows.findIndex(cut);
	let moved = 0;
	if (index === -1 && movable) {
		// Several that take no time: one after the other, as they will start.
		index = rows.findIndex(over);
		const before = rows[index]?.at(-1);
		if (before) moved = before.from + room.mark - from;
	}
	if (index === -1) index = rows.length;
	const row = (rows[index] ??= []);
	const before = last(row);
	if (before) before.to = Math.min(before.to, from + moved);
	row.push({ step, from: from + moved, until: until + moved, to: to + moved, row: index });
}

/** How high a lane is where all share `room`; those that need more than their share take it from the others. */
export function laneHeight(needs: readonly number[], room: number): number {
	const rest = needs.toSorted((a, b) => b - a);
	let left = room;
	for (let most = rest[0]; most !== undefined && most > left / rest.length; most = rest[0]) {
		left -= most;
		rest.shift();
	}
	return rest.length === 0 ? 0 : left / rest.length;
}
