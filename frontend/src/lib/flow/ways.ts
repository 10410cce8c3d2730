/** How a wire is drawn that has corners. */
import type { Point } from './layout.ts';

/** Pixels by which a corner is round. */
const ROUND = 8;

const towards = (from: Point, to: Point, by: number): Point => {
	const length = Math.hypot(to.x - from.x, to.y - from.y);
	const part = length === 0 ? 0 : Math.min(by, length / 2) / length;
	return { x: from.x + (to.x - from.x) * part, y: from.y + (to.y - from.y) * part };
};

/** The path of an SVG through `points`, round at the corners. */
export function pathOf(points: readonly Point[]): string {
	const written = ({ x, y }: Point): string => `${x},${y}`;
	return points
		.map((point, at) => {
			const before = points[at - 1];
			const after = points[at + 1];
			if (!before) return `M${written(point)}`;
			if (!after) return `L${written(point)}`;
			return `L${written(towards(point, before, ROUND))}Q${written(point)} ${written(towards(point, after, ROUND))}`;
		})
		.join('');
}

/** The middle of the longest level piece: the words stand there. */
export function middleOf(points: readonly Point[]): Point {
	let best = { length: -1, middle: points[0] ?? { x: 0, y: 0 } };
	points.slice(1).forEach((to, at) => {
		const from = points[at];
		if (!from || Math.abs(from.y - to.y) > 1) return;
		const length = Math.abs(to.x - from.x);
		if (length > best.length) best = { length, middle: { x: (from.x + to.x) / 2, y: from.y } };
	});
	return best.middle;
}
