/** Where something comes to rest while it is dragged: on a grid, and at the edges and middles of what is beside it. */
import type { Box, Point } from '#lib/mimic/geometry.ts';

export const GRID = 2;
/** Units within which an edge takes hold. */
const NEAR = 4;

type Axis = 'x' | 'y';
const LENGTH = { x: 'width', y: 'height' } as const;

/** A line at which it has come to rest. */
export interface Guide {
	readonly axis: Axis;
	readonly at: number;
}

export interface Snapped {
	readonly dx: number;
	readonly dy: number;
	readonly guides: readonly Guide[];
}

/** The two edges and the middle; of what has no size one place. */
function lines(box: Box, axis: Axis): number[] {
	const [from, length] = [box[axis], box[LENGTH[axis]]];
	return length === 0 ? [from] : [from, from + length / 2, from + length];
}

const onGrid = (value: number): number => Math.round(value / GRID) * GRID;

function along(axis: Axis, own: readonly number[], others: readonly Box[], by: number, from: number): { by: number; guide: Guide | null } {
	let best: { by: number; guide: Guide | null } = { by: onGrid(from + by) - from, guide: null };
	let least = NEAR + 0.001;
	for (const line of others.flatMap((box) => lines(box, axis)))
		for (const each of own) {
			const far = Math.abs(each + by - line);
			if (far >= least) continue;
			least = far;
			best = { by: line - each, guide: { axis, at: line } };
		}
	return best;
}

function both(x: ReturnType<typeof along>, y: ReturnType<typeof along>): Snapped {
	return { dx: x.by, dy: y.by, guides: [x.guide, y.guide].flatMap((each) => each ?? []) };
}

/** How far something goes that is dragged so far, among what stays where it is. `at` is what comes to lie on the grid. */
export function snapped(box: Box, at: Point, others: readonly Box[], dx: number, dy: number): Snapped {
	return both(along('x', lines(box, 'x'), others, dx, at.x), along('y', lines(box, 'y'), others, dy, at.y));
}

/** How much wider and higher something becomes whose lower right corner is dragged so far; never less than `least`. */
export function resized(box: Box, others: readonly Box[], dx: number, dy: number, least: number): Snapped {
	const [right, bottom] = [box.x + box.width, box.y + box.height];
	const found = both(along('x', [right], others, dx, right), along('y', [bottom], others, dy, bottom));
	return { ...found, dx: Math.max(found.dx, least - box.width), dy: Math.max(found.dy, least - box.height) };
}
