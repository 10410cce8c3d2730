/**
 * The plan as a picture: one lane per resource; columns for what has begun, the present, columns for what is ahead.
 *
 * What has begun is known: it stands at the instant of its start, whichever plan it came from, and is drawn over every
 * column that began while it ran. What is ahead is only ordered: the plan says in which tick an ability starts and never
 * when it ends, so a step that is still to come fills its own column alone.
 */
import type { PlanStep } from '#lib/contract.ts';

/** Columns of the past that are shown at most; older starts would only push the present out of sight. */
export const PAST_COLUMNS = 8;

export interface Block {
	readonly step: PlanStep;
	/** First column, from 0: those of `begun`, then those ahead. */
	readonly column: number;
	/** Columns covered, at least 1. */
	readonly span: number;
	/** Row within the lane, from 0: blocks of one row never overlap. */
	readonly row: number;
	/** It began before the first column. */
	readonly continued: boolean;
}

export interface Lane {
	readonly resource: string;
	readonly rows: number;
	readonly blocks: readonly Block[];
}

export interface Chart {
	/** The instant of each column that has begun, in seconds, ascending. The present lies after them. */
	readonly begun: readonly number[];
	/** How many columns lie ahead. */
	readonly ahead: number;
	readonly lanes: readonly Lane[];
}

type Begun = PlanStep & { readonly started: number };

/** Whether a step has been started. */
export function hasBegun(step: PlanStep): step is Begun {
	return step.started !== null;
}

/** The last `columns` instants at which something started, ascending. */
function latestStarts(steps: readonly PlanStep[], columns: number): number[] {
	return distinct(steps.filter(hasBegun).map((step) => step.started)).slice(-columns);
}

/** The steps that reach into the last `columns` starts or lie ahead; those that ended before are history. */
export function shownSteps(all: readonly PlanStep[], columns = PAST_COLUMNS): PlanStep[] {
	const first = latestStarts(all, columns)[0] ?? -Infinity;
	return all.filter((step) => !hasBegun(step) || step.started >= first || step.ended === null || step.ended > first);
}

/**
 * Lays out the steps of a plan, of which those ahead come in the order of their start. There is a lane for each of
 * `resources`, and at most `columns` (1 or more) of the past.
 */
export function layOut(all: readonly PlanStep[], resources: readonly string[], columns = PAST_COLUMNS): Chart {
	const steps = shownSteps(all, columns);
	const begun = latestStarts(steps, columns);
	const ticks = ticksAhead(steps);
	const ahead = distinct([...ticks.values()]);

	function place(step: PlanStep): Omit<Block, 'row'> {
		if (!hasBegun(step)) {
			const column = begun.length + ahead.indexOf(ticks.get(step) ?? 0);
			return { step, column, span: 1, continued: false };
		}
		const column = Math.max(0, begun.indexOf(step.started));
		const until = step.ended ?? Infinity;
		const end = begun.filter((instant) => instant < until).length;
		return { step, column, span: Math.max(1, end - column), continued: !begun.includes(step.started) };
	}

	const names = new Set([...resources, ...steps.map((step) => step.resource)]);
	const lanes = [...names].map((resource): Lane => {
		const blocks = pack(steps.filter((step) => step.resource === resource).map(place));
		return { resource, blocks, rows: Math.max(1, ...blocks.map((block) => block.row + 1)) };
	});
	return { begun, ahead: ahead.length, lanes };
}

/**
 * The tick under which each step ahead is drawn: its own, unless one that starts earlier has a later one. The order of
 * the starts is what will happen; a step that was pulled forward keeps the tick it once had.
 */
function ticksAhead(steps: readonly PlanStep[]): Map<PlanStep, number> {
	let latest = -Infinity;
	const ticks = new Map<PlanStep, number>();
	for (const step of steps) {
		if (hasBegun(step)) continue;
		latest = Math.max(latest, step.tick);
		ticks.set(step, latest);
	}
	return ticks;
}

function distinct(numbers: readonly number[]): number[] {
	return [...new Set(numbers)].sort((a, b) => a - b);
}

/** Gives each block the first row in which it overlaps none before it. */
function pack(blocks: readonly Omit<Block, 'row'>[]): Block[] {
	const ends: number[] = [];
	return [...blocks]
		.sort((a, b) => a.column - b.column)
		.map((block) => {
			const free = ends.findIndex((end) => end <= block.column);
			const row = free === -1 ? ends.length : free;
			ends[row] = block.column + block.span;
			return { ...block, row };
		});
}
