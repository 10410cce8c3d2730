/**
 * Lays the graph out from left to right, by ELK in a worker of its own: a large graph takes a while, in which the page goes
 * on. What is written first stands higher, so that a small change leaves the rest where it was.
 */
import ELK, { type ELK as Engine, type ElkNode } from 'elkjs/lib/elk-api';
import workerUrl from 'elkjs/lib/elk-worker.min.js?url';
import type { Layout, Picture, Point } from './picture.ts';

/** The sizes of boxes in pixels, and of the room between them. */
export interface Sizes {
	readonly width: number;
	readonly height: number;
	/** Between what follows one another: the words on a wire stand there. */
	readonly between: number;
	readonly apart: number;
}

/** The sizes for text of `rem` pixels. */
export const sizesFor = (rem: number): Sizes => ({ width: 12.5 * rem, height: 4.75 * rem, between: 8 * rem, apart: rem });

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

function asked({ boxes, wires }: Picture, sizes: Sizes): ElkNode {
	const { width, height } = sizes;
	const port = (id: string, side: 'WEST' | 'EAST') => ({
		id: `${id}|${side}`,
		x: side === 'WEST' ? 0 : width,
		y: height / 2,
		width: 0,
		height: 0,
		layoutOptions: { 'elk.port.side': side }
	});
	return {
		id: 'root',
		layoutOptions: options(sizes),
		children: boxes.map(({ id }) => ({
			id,
			width,
			height,
			ports: [port(id, 'WEST'), port(id, 'EAST')],
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

/** Where everything of `picture` is. */
export async function laidOut(picture: Picture, sizes: Sizes): Promise<Layout> {
	engine ??= new ELK({ workerUrl });
	return found(await engine.layout(asked(picture, sizes)));
}
