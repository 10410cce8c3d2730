/**
 * Lays the graph out from left to right, by ELK in a worker of its own: a large graph takes a while, in which the page goes
 * on. What is written first stands higher, so that a small change leaves the rest where it was.
 */
import ELK, { type ELK as Engine, type ElkNode } from 'elkjs/lib/elk-api';
import type { Node } from '@xyflow/svelte';
import workerUrl from 'elkjs/lib/elk-worker.min.js?url';

export interface Point {
	readonly x: number;
	readonly y: number;
}

/** Where everything is. */
export interface Layout {
	readonly places: ReadonlyMap<string, Point>;
	/** The corners of each wire, from its source to its target. */
	readonly ways: ReadonlyMap<string, readonly Point[]>;
}

/** Where lines end at a box: in the middle of its left side, and of its right one. */
export function handlesOf(width: number, height: number): Node['handles'] & {} {
	const at = { y: height / 2, width: 1, height: 1 };
	return [
		{ ...at, type: 'target', position: 'left', x: 0 },
		{ ...at, type: 'source', position: 'right', x: width }
	] as Node['handles'] & {};
}

/** What is laid out: boxes and what leads from one to another. */
export interface Laid {
	/** A box has a height of its own where it says so. */
	readonly boxes: readonly { readonly id: string; readonly height?: number }[];
	readonly wires: readonly { readonly id: string; readonly from: string; readonly to: string }[];
}

/** The sizes of boxes in pixels, and of the room between them. */
export interface Sizes {
	readonly width: number;
	readonly height: number;
	/** Between what follows one another: the words on a wire stand there. */
	readonly between: number;
	readonly apart: number;
}

const options = ({ between, apart }: Sizes): Record<string, string> => ({
	'elk.algorithm': 'layered',
	'elk.direction': 'RIGHT',
	'elk.edgeRouting': 'ORTHOGONAL',
	'elk.layered.considerModelOrder.strategy': 'NODES_AND_EDGES',
	'elk.layered.considerModelOrder.components': 'MODEL_ORDER',
	'elk.layered.nodePlacement.strategy': 'BRANDES_KOEPF',
	'elk.layered.nodePlacement.bk.fixedAlignment': 'BALANCED',
	'elk.layered.spacing.nodeNodeBetweenLayers': String(between),
	'elk.layered.spacing.edgeNodeBetweenLayers': String(apart),
	'elk.spacing.nodeNode': String(apart),
	'elk.spacing.edgeNode': String(apart),
	'elk.spacing.componentComponent': String(apart * 2.5),
	'elk.padding': '[top=0,left=0,bottom=0,right=0]'
});

function asked({ boxes, wires }: Laid, sizes: Sizes, further: Readonly<Record<string, string>>): ElkNode {
	const { width } = sizes;
	const port = (id: string, height: number, side: 'WEST' | 'EAST') => ({
		id: `${id}|${side}`,
		x: side === 'WEST' ? 0 : width,
		y: height / 2,
		width: 0,
		height: 0,
		layoutOptions: { 'elk.port.side': side }
	});
	return {
		id: 'root',
		layoutOptions: { ...options(sizes), ...further },
		children: boxes.map(({ id, height = sizes.height }) => ({
			id,
			width,
			height,
			ports: [port(id, height, 'WEST'), port(id, height, 'EAST')],
			layoutOptions: { 'elk.portConstraints': 'FIXED_POS' }
		})),
		edges: wires.map(({ id, from, to }) => ({ id, sources: [`${from}|EAST`], targets: [`${to}|WEST`] }))
	};
}

function found({ children = [], edges = [] }: ElkNode): Layout {
	const places = new Map<string, Point>(children.map(({ id, x = 0, y = 0 }) => [id, { x, y }]));
	const ways = new Map<string, Point[]>(
		edges.map(({ id, sections = [] }) => [
			id,
			sections.flatMap(({ startPoint, bendPoints = [], endPoint }) => [startPoint, ...bendPoints, endPoint])
		])
	);
	return { places, ways };
}

let engine: Engine | null = null;

/** Where everything of `picture` is, laid out with `further` options of ELK. */
export async function laidOut(picture: Laid, sizes: Sizes, further: Readonly<Record<string, string>> = {}): Promise<Layout> {
	engine ??= new ELK({ workerUrl });
	return found(await engine.layout(asked(picture, sizes, further)));
}
