/**
 * The model as a whole, as the server finds it: things with names, and ties between them.
 *
 * What is drawn are pieces: things that are no part of another, as a value is of its enumeration. A piece *rests on*
 * others: an operation on the variables of its goal, a variable on who writes it or on the topic that feeds it, an
 * ability on the outputs through which it acts, and an output on the topic that carries it away. Down is what something
 * rests on, and up is what rests on it, and may change with it.
 */
import type { ModelGraph, ModelThing, ModelTie } from '#lib/contract.ts';

export type Manner = ModelTie['manner'];
export type ThingKind = keyof typeof KINDS;

/** All kinds of things, and whether one is a piece of its own on the map. */
const KINDS = {
	station: true,
	work_master: true,
	sequence: true,
	operation: true,
	specification: true,
	ability: true,
	alarm: true,
	effect: false,
	variable: true,
	topic: true,
	flow: true,
	service: true,
	action: true,
	enumeration: true,
	set: true,
	relation: true,
	map: true,
	predicate: true,
	value: false,
	parameter: false,
	resource: false,
	type: false,
	message: true
} as const;

/** A thing with its place in the list of all. */
export interface Thing extends ModelThing {
	readonly index: number;
}

export interface Whole {
	readonly number: number;
	readonly things: readonly Thing[];
	readonly byId: ReadonlyMap<string, Thing>;
	/** The piece that each thing is, or is a part of. */
	readonly pieceOf: readonly number[];
	/** The ties of each thing: those by which others use it, and those by which it uses others. */
	readonly usedBy: readonly (readonly ModelTie[])[];
	readonly uses: readonly (readonly ModelTie[])[];
	/** What is within each thing. */
	readonly inside: readonly (readonly number[])[];
	/** On which pieces each piece rests, and which rest on it. */
	readonly down: readonly ReadonlySet<number>[];
	readonly up: readonly ReadonlySet<number>[];
}

/** By these what is used rests on its user. */
const MADE: ReadonlySet<Manner> = new Set<Manner>(['writes', 'effect', 'feeds', 'commands']);

/** Whether something is drawn, rather than what it is a part of. */
export const isPiece = (thing: ModelThing): boolean => KINDS[thing.kind as ThingKind] && thing.within === null;

/** In which directions a tie goes: what is used rests on its user, or its user on it, or each on the other. */
function directionsOf({ manner }: ModelTie, used: ModelThing): { readonly user: boolean; readonly used: boolean } {
	if (manner === 'commands') return { user: true, used: true };
	if (MADE.has(manner) || (manner === 'sends' && used.section === 'output')) return { user: false, used: true };
	return { user: manner !== 'example', used: false };
}

export function wholeOf(graph: ModelGraph): Whole {
	const things = graph.things.map((thing, index): Thing => ({ ...thing, index }));
	const lists = <Value>(): Value[][] => things.map(() => []);
	const [usedBy, uses, inside] = [lists<ModelTie>(), lists<ModelTie>(), lists<number>()];
	const down = things.map(() => new Set<number>());
	const up = things.map(() => new Set<number>());
	const pieceOf = things.map(({ index }) => pieceAt(things, index));
	for (const { index, within } of things) if (within !== null) inside[within]?.push(index);

	const rest = (one: number, other: number): void => {
		if (one === other) return;
		down[one]?.add(other);
		up[other]?.add(one);
	};
	const fed = new Set(graph.ties.filter(({ manner }) => manner === 'feeds').map(({ thing, by }) => `${thing} ${by}`));
	for (const tie of graph.ties) {
		const used = things[tie.thing];
		const [one, other] = [pieceOf[tie.by], pieceOf[tie.thing]];
		if (used === undefined || one === undefined || other === undefined) continue;
		usedBy[tie.thing]?.push(tie);
		uses[tie.by]?.push(tie);
		// What a pipeline has made it reads again in its later stages.
		const isOwn = tie.manner === 'reads' && fed.has(`${tie.thing} ${tie.by}`);
		if (used.kind === 'resource' || isOwn) continue;
		const directions = directionsOf(tie, used);
		if (directions.user) rest(one, other);
		if (directions.used) rest(other, one);
	}
	const byId = new Map(things.map((thing) => [thing.id, thing]));
	return { number: graph.number, things, byId, pieceOf, usedBy, uses, inside, down, up };
}

function pieceAt(things: readonly Thing[], index: number): number {
	const seen = new Set<number>();
	let at = index;
	for (let within = things[at]?.within; within != null && !seen.has(at); within = things[at]?.within) {
		seen.add(at);
		at = within;
	}
	return at;
}

/** The thing, and all that is within it. */
export function withInside(whole: Whole, index: number): number[] {
	return [index, ...(whole.inside[index] ?? []).flatMap((each) => withInside(whole, each))];
}

/** Whether a tie, seen from the thing that is used, leads up to its user: else it leads down to it. */
export function leadsUp(whole: Whole, tie: ModelTie): boolean {
	const used = whole.things[tie.thing];
	return used === undefined || tie.manner === 'commands' || !directionsOf(tie, used).used;
}

/** A piece that is reached: after how many steps, and from which piece. */
export interface Step {
	readonly steps: number;
	readonly from: number;
}

/** What is reached from some pieces in so many steps, along `ways`; without these pieces themselves. */
export function reached(ways: Whole['down'], from: Iterable<number>, most = Infinity): Map<number, Step> {
	const found = new Map<number, Step>();
	const begun = new Set(from);
	let edge = [...begun];
	for (let steps = 1; steps <= most && edge.length > 0; steps++) {
		const next: number[] = [];
		for (const at of edge)
			for (const other of ways[at] ?? []) {
				if (begun.has(other) || found.has(other)) continue;
				found.set(other, { steps, from: at });
				next.push(other);
			}
		edge = next;
	}
	return found;
}

/** All that is tied to a piece: what is above it, and what is below. */
export interface Tied {
	readonly chosen: number;
	readonly up: ReadonlyMap<number, Step>;
	readonly down: ReadonlyMap<number, Step>;
}

/** Where a value, a parameter or a resource is chosen, what uses that itself is above it. */
export function tiedTo(whole: Whole, index: number, most: number): Tied {
	const chosen = whole.pieceOf[index] ?? index;
	const isWhole = chosen === index && whole.things[index]?.kind !== 'resource';
	if (isWhole) return { chosen, up: reached(whole.up, [chosen], most), down: reached(whole.down, [chosen], most) };
	const users = new Set((whole.usedBy[index] ?? []).map((tie) => whole.pieceOf[tie.by] ?? tie.by));
	users.delete(chosen);
	const up = new Map([...users].map((user): [number, Step] => [user, { steps: 1, from: chosen }]));
	for (const [piece, { steps, from }] of reached(whole.up, users, most - 1))
		if (piece !== chosen) up.set(piece, { steps: steps + 1, from });
	return { chosen, up, down: new Map() };
}
