/** What waits for what, as lines from the step that makes another possible to that one. */
import type { Block, Lane } from './lanes.ts';

export interface Link {
	readonly from: string;
	readonly to: string;
	/** In seconds after the present: where it leaves what is waited for, and where what waits begins. */
	readonly leaves: number;
	readonly arrives: number;
	/** The places of the two among the lanes, and their rows there. */
	readonly lanes: readonly [number, number];
	readonly rows: readonly [number, number];
}

/** One for each step ahead that waits for a step of another lane; within a lane the order says it. */
export function linksOf(lanes: readonly Lane[]): Link[] {
	const drawn = new Map<string, { block: Block; lane: number }>();
	for (const [lane, { blocks }] of lanes.entries()) for (const block of blocks) drawn.set(block.step.id, { block, lane });
	const links: Link[] = [];
	for (const { block, lane } of drawn.values()) {
		const cause = block.step.started === null && block.step.after !== null ? drawn.get(block.step.after) : undefined;
		if (cause === undefined || cause.lane === lane) continue;
		links.push({
			from: cause.block.step.id,
			to: block.step.id,
			leaves: Math.min(Math.max(cause.block.until, 0), block.from),
			arrives: block.from,
			lanes: [cause.lane, lane],
			rows: [cause.block.row, block.row]
		});
	}
	return links;
}

/** A line of right angles between two points, in the unit of `bend`, which it keeps from its end where there is room. */
export function pathOf(x1: number, y1: number, x2: number, y2: number, bend: number): string {
	const turn = x2 - x1 > 2 * bend ? x2 - bend : x1 + (x2 - x1) / 2;
	return `M${x1} ${y1}H${turn}V${y2}H${x2}`;
}
