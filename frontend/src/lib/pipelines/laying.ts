/** Where the boxes of a graph stand: each lane laid out for itself, one below the other. */
import { laidOut, type Layout, type Point, type Sizes } from '#lib/flow/layout.ts';
import type { Box, Lane } from './picture.ts';

/** Sizes in rem: of a box, its head, a line of it and what is around those; between boxes, and between lanes. */
const [WIDTH, HEAD, LINE, AROUND] = [13, 3.125, 1.25, 0.5];
const [BETWEEN, APART] = [6, 1];
const [LANE, TITLE] = [2.5, 2];

export interface Laid extends Layout {
	/** Where the title of each lane stands. */
	readonly titles: ReadonlyMap<string, Point>;
}

export const widthFor = (rem: number): number => WIDTH * rem;

/** The height of a box for text of `rem` pixels. */
export function heightOf({ kind, rows, more }: Pick<Box, 'kind' | 'rows' | 'more'>, rem: number): number {
	const lines = kind === 'variable' ? 1 : rows.length + (more > 0 ? 1 : 0);
	return (HEAD + (lines > 0 ? lines * LINE + AROUND : 0)) * rem;
}

const sizesFor = (rem: number): Sizes => ({ width: WIDTH * rem, height: HEAD * rem, between: BETWEEN * rem, apart: APART * rem });

/** Lays lanes out for text of `rem` pixels. */
export async function lanesLaidOut(lanes: readonly Lane[], rem: number): Promise<Laid> {
	const each = await Promise.all(
		lanes.map(({ boxes, wires }) => laidOut({ boxes: boxes.map((box) => ({ id: box.id, height: heightOf(box, rem) })), wires }, sizesFor(rem)))
	);
	const [places, ways, titles] = [new Map<string, Point>(), new Map<string, readonly Point[]>(), new Map<string, Point>()];
	let top = 0;
	for (const [at, { id, title, boxes }] of lanes.entries()) {
		const layout = each[at];
		if (!layout) continue;
		if (title !== '') {
			titles.set(id, { x: 0, y: top });
			top += TITLE * rem;
		}
		const down = ({ x, y }: Point): Point => ({ x, y: y + top });
		for (const [box, place] of layout.places) places.set(box, down(place));
		for (const [wire, points] of layout.ways) ways.set(wire, points.map(down));
		top += Math.max(0, ...boxes.map((box) => (layout.places.get(box.id)?.y ?? 0) + heightOf(box, rem))) + LANE * rem;
	}
	return { places, ways, titles };
}
