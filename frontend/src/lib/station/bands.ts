/** The map of a model: its layers as bands from 3 to 0, in each a lane for every resource, and in that its pieces. */
import { isPiece, type Thing, type Whole } from './graph.ts';

export type Layer = 0 | 1 | 2 | 3;
export const LAYERS: readonly Layer[] = [3, 2, 1, 0];

export interface Lane {
	/** It stays the same while the model is edited. */
	readonly key: string;
	/** The resource; null for what belongs to the station as a whole. */
	readonly resource: string | null;
	readonly pieces: readonly Thing[];
}

export interface Band {
	readonly layer: Layer;
	readonly lanes: readonly Lane[];
	readonly count: number;
}

/** What is shown of it. */
export interface Filter {
	/** A resource, `''` for all of them, and `-` for what belongs to none. */
	readonly resource: string;
	/** A kind of thing, or the section of a variable; `''` for all. */
	readonly kind: string;
}

/** What belongs to the station as a whole, where a resource is chosen. */
export const OF_STATION = '-';
/** In which order kinds stand in a lane. */
const ORDER = [
	'work_master',
	'sequence',
	'operation',
	'specification',
	'station',
	'ability',
	'alarm',
	'estimated',
	'output',
	'measured',
	'variable',
	'flow',
	'topic',
	'service',
	'action',
	'predicate',
	'relation',
	'map',
	'set',
	'enumeration',
	'message'
] as const;
export type Kind = (typeof ORDER)[number];

/** The kind by which a piece is told from others: of a variable its section. */
export const kindOf = (thing: Thing): Kind => (thing.section ?? thing.kind) as Kind;

const keyOf = (layer: number, resource: string | null): string => `${layer} ${resource ?? ''}`;
/** The key of the lane in which a piece is. */
export const laneOf = ({ layer, resource }: Thing): string => keyOf(layer, resource);

export function fits(thing: Thing, { resource, kind }: Filter): boolean {
	if (resource !== '' && (thing.resource ?? OF_STATION) !== resource) return false;
	return kind === '' || kindOf(thing) === kind;
}

/** The kinds of all pieces, in their order. */
export function kindsIn(whole: Whole): Kind[] {
	const there = new Set(whole.things.filter(isPiece).map(kindOf));
	return ORDER.filter((kind) => there.has(kind));
}

export function bandsOf(whole: Whole, filter: Filter): Band[] {
	const resources = whole.things.filter(({ kind }) => kind === 'resource').map(({ name }) => name);
	const order = new Map([null, ...resources].map((name, place) => [name, place]));
	return LAYERS.map((layer) => {
		const lanes = new Map<string | null, Thing[]>();
		for (const thing of whole.things) {
			if (thing.layer !== layer || !isPiece(thing) || !fits(thing, filter)) continue;
			const lane = lanes.get(thing.resource);
			if (lane) lane.push(thing);
			else lanes.set(thing.resource, [thing]);
		}
		const found = [...lanes].map(([resource, pieces]): Lane => {
			const ordered = pieces.sort((one, other) => ORDER.indexOf(kindOf(one)) - ORDER.indexOf(kindOf(other)));
			return { key: keyOf(layer, resource), resource, pieces: ordered };
		});
		found.sort((one, other) => (order.get(one.resource) ?? Infinity) - (order.get(other.resource) ?? Infinity));
		return { layer, lanes: found, count: found.reduce((sum, { pieces }) => sum + pieces.length, 0) };
	});
}

/** Of more pieces than this the lanes are closed at first. */
const MOST_OPEN = 300;

export const isLarge = ({ things }: Whole): boolean => things.filter(isPiece).length > MOST_OPEN;

/** How many pieces of each kind there are, in their order. */
export function countsIn(pieces: readonly Thing[]): [Kind, number][] {
	const counts = new Map<Kind, number>();
	for (const piece of pieces) counts.set(kindOf(piece), (counts.get(kindOf(piece)) ?? 0) + 1);
	return ORDER.flatMap((kind): [Kind, number][] => (counts.has(kind) ? [[kind, counts.get(kind) ?? 0]] : []));
}

/** What people call it, for any value of its parameters; null where it has no title, or one that is nothing but such a value. */
export function spokenName({ title }: Thing): string | null {
	if (title === null || /^\{[^}]*\}$/.test(title)) return null;
	return title.replace(/\{([^}]*)\}/g, (_, parameter: string) => parameter.replaceAll('_', ' '));
}

/** What a piece is called in its lane, where its resource is said already. */
export function shortName(thing: Thing): string {
	const prefix = `${thing.resource ?? ''}.`;
	return thing.name.startsWith(prefix) ? thing.name.slice(prefix.length) : thing.name;
}
