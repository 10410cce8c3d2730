/** What of a state space is drawn, and what its nodes and arrows look like. */
import type { FoldedState, StateArrow, StateSpaceTold } from '#lib/contract.ts';

/** How a node stands out: by the worst that stands behind it. */
export type Standing = 'forbidden' | 'unsafe' | 'safe';

/** The worst of a node, and whether all that stands behind it is so. */
export function standingOf(node: FoldedState): { readonly kind: Standing; readonly all: boolean } {
	if (node.forbidden > 0) return { kind: 'forbidden', all: node.forbidden === node.states };
	if (node.unsafe > 0) return { kind: 'unsafe', all: node.unsafe === node.states };
	return { kind: 'safe', all: true };
}

/** The pairs of nodes that a plan goes through, as `from to`. */
export function onPath(path: readonly { readonly node: number | null }[]): ReadonlySet<string> {
	const pairs = new Set<string>();
	path.slice(1).forEach(({ node }, at) => {
		const before = path[at]?.node ?? null;
		if (before !== null && node !== null && before !== node) pairs.add(pairOf(before, node));
	});
	return pairs;
}

export const pairOf = (source: number, sink: number): string => `${source} ${sink}`;

const isTogether = ({ causes }: StateArrow): boolean => causes.every(({ kind }) => kind === 'together');

/**
 * The arrows that are drawn. What only several things at once lead to is left out, unless that is wanted, the plan goes there
 * or nothing else leads there.
 */
export function drawnArrows(view: Pick<StateSpaceTold, 'arrows' | 'path'>, together: boolean): readonly StateArrow[] {
	if (together) return view.arrows;
	const path = onPath(view.path ?? []);
	const led = new Set(view.arrows.filter((arrow) => !isTogether(arrow)).map(({ sink }) => sink));
	return view.arrows.filter((arrow) => !isTogether(arrow) || !led.has(arrow.sink) || path.has(pairOf(arrow.source, arrow.sink)));
}

/** What an arrow looks like: a start that is kept back everywhere, something that nobody counts on, or something else. */
export function lookOf(arrow: StateArrow): 'kept' | 'fault' | 'together' | 'start' | 'device' {
	if (isTogether(arrow)) return 'together';
	if (arrow.causes.every(({ kind, allowed }) => kind === 'start' && !allowed)) return 'kept';
	if (arrow.causes.every(({ kind }) => kind === 'fault')) return 'fault';
	return arrow.causes.some(({ kind, allowed }) => kind === 'start' && allowed) ? 'start' : 'device';
}

/** How wide a text is, in pixels. */
export type Measure = (text: string, isStrong: boolean) => number;

/** The lines that a text takes where its words are put into lines of this width; a word that is longer is broken. */
export function linesOf(text: string, width: number, measure: (text: string) => number): number {
	let [lines, line] = [1, ''];
	for (const word of text.split(' ')) {
		const longer = line === '' ? word : `${line} ${word}`;
		if (measure(longer) <= width) line = longer;
		else {
			if (line !== '') lines++;
			const broken = Math.max(1, Math.ceil(measure(word) / width));
			lines += broken - 1;
			line = word;
		}
	}
	return lines;
}

/** The lines of a chosen variable in each node: beside its name where each value has room there, or else below it. */
export interface ValueLines {
	readonly below: boolean;
	readonly name: number;
	/** Of the longest value. */
	readonly value: number;
}

/** How the name of a variable and any of its values are set in a node with so much room, with `most` lines for each at most. */
export function valueLines(name: string, values: readonly string[], room: { readonly width: number; readonly gap: number; readonly most: number }, measure: Measure): ValueLines {
	const widths = values.map((value) => measure(value, true));
	if (measure(name, false) + room.gap + Math.max(0, ...widths) <= room.width) return { below: false, name: 1, value: 1 };
	const lines = (text: string, isStrong: boolean): number => Math.min(room.most, linesOf(text, room.width, (each) => measure(each, isStrong)));
	return { below: true, name: lines(name, false), value: Math.max(1, ...values.map((value) => lines(value, true))) };
}
