/** The parts of a model as a tree: made from what its files hold. */
import type { FileMark } from '#lib/contract.ts';
import { language } from '#lib/text/text.svelte.ts';
import { entriesOf, isMapping, textAt, titleAt, valueAt, type Json, type Path } from './content.ts';
import { inherited, layersOf, namesIn, removedFrom, typeOf, type Layer } from './types.ts';

/** What a person can make, name and delete. */
export type EntryKind =
	| 'enumeration'
	| 'variable'
	| 'resource'
	| 'type'
	| 'topic'
	| 'flow'
	| 'service'
	| 'action'
	| 'ability'
	| 'effect'
	| 'alarm'
	| 'set'
	| 'relation'
	| 'map'
	| 'predicate'
	| 'operation'
	| 'sequence'
	| 'specification'
	| 'work_master'
	| 'symbol'
	| 'shift'
	| 'scenario'
	| 'message';

/** Where entries of one kind stand together. */
export type SectionName =
	| 'enumerations'
	| 'variables'
	| 'resources'
	| 'types'
	| 'topics'
	| 'flows'
	| 'services'
	| 'actions'
	| 'measured'
	| 'output'
	| 'estimated'
	| 'abilities'
	| 'alarms'
	| 'station_alarms'
	| 'sets'
	| 'relations'
	| 'maps'
	| 'predicates'
	| 'station_predicates'
	| 'operations'
	| 'specifications'
	| 'work_masters'
	| 'picture'
	| 'shifts'
	| 'tests'
	| 'messages';

export interface Node {
	/** Its file and path: the same for as long as it is called so. */
	readonly id: string;
	readonly kind: EntryKind | 'station' | 'section';
	/** What it is called in the model; the name of the section for one. */
	readonly name: string;
	readonly title: string | null;
	/** Empty for a section of files. */
	readonly file: string;
	readonly path: Path;
	readonly children: readonly Node[];
	/** The type of which an instance has it, and says nothing of it itself. */
	readonly of?: string;
	/** The resource by which it is named: for what is in a type, an instance of that; null where there is none. */
	readonly owner?: string | null;
	/** What stands for values in an effect that is written once for several. */
	readonly words?: readonly string[];
}

export const STATION = 'station.yaml';
/** The file of the live picture. */
export const PICTURE = 'mimic.yaml';
const SHIFTS = 'shifts.yaml';
/** The file that tests stand in which are made here. */
export const SCENARIOS = 'tests/scenarios.yaml';
const hasScenarios = (file: string): boolean => /^tests\/\w+\.yaml$/.test(file);
const IN_FILES = { operations: 'operation', specifications: 'specification', work_masters: 'work_master' } as const;

/** The sections of a resource, by the key under which each stands, and what is in them. */
export const IN_RESOURCE = {
	topics: 'topic',
	flows: 'flow',
	services: 'service',
	actions: 'action',
	measured: 'variable',
	output: 'variable',
	estimated: 'variable',
	abilities: 'ability',
	alarms: 'alarm',
	predicates: 'predicate'
} as const satisfies Partial<Record<SectionName, EntryKind>>;

/** What a station says once by a name: shown where there is some. */
const SHORT = [
	['sets', 'sets', 'set'],
	['relations', 'relations', 'relation'],
	['maps', 'maps', 'map'],
	['station_predicates', 'predicates', 'predicate']
] as const satisfies readonly (readonly [SectionName, string, EntryKind])[];

/** What makes a sequence of an entry among the operations. */
const ORDERS = ['sequence', 'parallel', 'alternative', 'arbitrary'];
const isSequence = (value: Json): boolean => isMapping(value) && ORDERS.some((each) => each in value);

export type InResource = keyof typeof IN_RESOURCE;

export const idOf = (file: string, path: Path): string => [file, ...path.map((step) => encodeURIComponent(step))].join('#');

/** The file of a resource is called after it; null where the file is another one. */
export const resourceOf = (file: string): string | null => /^resources\/(\w+)\.yaml$/.exec(file)?.[1] ?? null;
/** `messages/p/msg/Name.msg` is the definition `p/msg/Name`. */
export const messageOf = (file: string): string | null => /^messages\/(\w+\/(?:msg|srv|action)\/\w+)\.\w+$/.exec(file)?.[1] ?? null;
/** Where the definition `p/msg/Name` stands. */
export const messageFile = (name: string): string => `messages/${name}.${name.split('/')[1] ?? 'msg'}`;

function entry(kind: EntryKind, file: string, path: Path, value: Json, children: readonly Node[] = []): Node {
	const title = titleAt(value, ['title'], language());
	const words = kind === 'effect' ? entriesOf(valueAt(value, ['for'])).map(([word]) => word) : [];
	const made = { id: idOf(file, path), kind, name: String(path.at(-1)), title, file, path, children };
	return words.length > 0 ? { ...made, words } : made;
}

function section(name: SectionName, file: string, path: Path, children: readonly Node[]): Node {
	const id = file === '' ? `#${name}` : idOf(file, path);
	return { id, kind: 'section', name, title: null, file, path, children };
}

function entriesIn(kind: EntryKind, file: string, path: Path, content: Json | undefined, layers: readonly Layer[] = []): Node[] {
	const own = entriesOf(valueAt(content, path));
	const others = namesIn(layers, path, removedFrom(content)).filter(([name]) => own.every(([each]) => each !== name));
	const within = (here: Path): Node[] => (kind === 'ability' ? entriesIn('effect', file, [...here, 'effects'], content, layers) : []);
	return [
		...own.map(([name, value]) => {
			const here = [...path, name];
			if (kind === 'operation' && isSequence(value)) return entry('sequence', file, here, value);
			return entry(kind, file, here, value, within(here));
		}),
		...others.map(([name, of]) => {
			const here = [...path, name];
			return { ...entry(kind, file, here, inherited(layers, here)?.value ?? null, within(here)), of };
		})
	];
}

/**
 * The resource of each content that was made into one, and the contents of its types: an edit of one file leaves all
 * others what they were.
 */
const RESOURCES = new WeakMap<object, readonly [made: Node, of: readonly (Json | undefined)[], language: string]>();

function resource(file: string, name: string, content: Json | undefined, layers: readonly Layer[]): Node {
	if (!isMapping(content)) return resourceFrom(file, name, content, layers);
	const [before, of = [], spoken] = RESOURCES.get(content) ?? [];
	if (before?.file === file && spoken === language() && of.length === layers.length && layers.every((each, at) => each.content === of[at])) return before;
	const made = resourceFrom(file, name, content, layers);
	RESOURCES.set(content, [made, layers.map((each) => each.content), language()]);
	return made;
}

function resourceFrom(file: string, name: string, content: Json | undefined, layers: readonly Layer[]): Node {
	const sections = (Object.keys(IN_RESOURCE) as InResource[])
		.map((key) => section(key, file, [key], entriesIn(IN_RESOURCE[key], file, [key], content, layers)))
		.filter(({ children }) => children.length > 0);
	const title = titleAt(content, ['title'], language()) ?? titleAt(inherited(layers, ['title'])?.value, [], language());
	return { ...entry('resource', file, [], isMapping(content) ? content : {}, sections), name, title };
}

/** A type; what is in it is named by the resource `owner`, the first of the instances. */
function typeFrom(file: string, name: string, content: Json | undefined, owner: string | null): Node {
	const owned = (node: Node): Node => ({ ...node, owner, children: node.children.map(owned) });
	const made = resourceFrom(file, name, content, []);
	return { ...made, kind: 'type', children: made.children.map(owned) };
}

/** The tree of a model of these files; `contents` has what was last read of each. */
export function treeOf(
	files: Readonly<Record<string, Pick<FileMark, 'digest'>>>,
	contents: Readonly<Record<string, Json | undefined>>
): Node[] {
	const there = Object.keys(files).filter((path) => files[path]?.digest !== null).sort();
	const station = contents[STATION];
	const resources = there.flatMap((file) => {
		const name = resourceOf(file);
		return name === null ? [] : [resource(file, name, contents[file], layersOf(file, contents))];
	});
	const owners = new Map<string, string>();
	for (const file of there.toReversed())
		for (const layer of layersOf(file, contents)) owners.set(layer.file, resourceOf(file) ?? owners.get(file) ?? '');
	const types = there.flatMap((file): Node[] => {
		const name = typeOf(file);
		return name === null ? [] : [typeFrom(file, name, contents[file], owners.get(file) || null)];
	});
	const messages = there.flatMap((file): Node[] => {
		const name = messageOf(file);
		return name === null ? [] : [{ id: idOf(file, []), kind: 'message', name, title: null, file, path: [], children: [] }];
	});
	const tests = there.filter(hasScenarios).flatMap((file) => entriesIn('scenario', file, [], contents[file]));
	return [
		{
			id: idOf(STATION, []),
			kind: 'station',
			name: textAt(station, ['name']) ?? '',
			title: titleAt(station, ['title'], language()),
			file: STATION,
			path: [],
			children: [
				section('enumerations', STATION, ['enumerations'], entriesIn('enumeration', STATION, ['enumerations'], station)),
				...SHORT.map(([name, key, kind]) => section(name, STATION, [key], entriesIn(kind, STATION, [key], station))).filter(
					({ children }) => children.length > 0
				),
				section('variables', STATION, ['estimated'], entriesIn('variable', STATION, ['estimated'], station)),
				section('station_alarms', STATION, ['alarms'], entriesIn('alarm', STATION, ['alarms'], station))
			]
		},
		section('resources', '', [], resources),
		...(types.length > 0 ? [section('types', '', [], types)] : []),
		...(Object.entries(IN_FILES) as [keyof typeof IN_FILES, EntryKind][]).map(([name, kind]) => {
			const file = `${name}.yaml`;
			return section(name, file, [], entriesIn(kind, file, [], contents[file]));
		}),
		section('picture', PICTURE, [], entriesIn('symbol', PICTURE, ['symbols'], contents[PICTURE])),
		section('shifts', SHIFTS, [], entriesIn('shift', SHIFTS, [], contents[SHIFTS])),
		section('tests', '', [], tests),
		section('messages', '', [], messages)
	];
}

/** All nodes, each before those in it. */
export function* nodesOf(tree: readonly Node[]): Generator<Node> {
	for (const node of tree) {
		yield node;
		yield* nodesOf(node.children);
	}
}

/** Nodes by an id. */
export interface Nodes {
	get(id: string): Node | undefined;
	has(id: string): boolean;
	values(): Iterable<Node>;
}

/** A tree as it can be looked up. */
export interface Lookup {
	readonly byId: Nodes;
	readonly parents: Pick<Nodes, 'get'>;
}

/** A part of a tree as it can be looked up: `parents` has those of all nodes below its first. */
interface Part {
	readonly byId: Map<string, Node>;
	readonly parents: Map<string, Node>;
}

/** What each resource was found to hold. */
const PARTS = new WeakMap<Node, Part>();

function partFrom(tree: Iterable<Node>): Part {
	const part: Part = { byId: new Map(), parents: new Map() };
	for (const node of tree) {
		part.byId.set(node.id, node);
		for (const child of node.children) part.parents.set(child.id, node);
	}
	return part;
}

/** Whether what is in it is looked up by its file: it is a resource, or a type of some. */
const hasFile = ({ kind }: Node): boolean => kind === 'resource' || kind === 'type';

/** All nodes but those within resources and types, each before those in it. */
function* aroundResources(tree: readonly Node[]): Generator<Node> {
	for (const node of tree) {
		yield node;
		if (!hasFile(node)) yield* aroundResources(node.children);
	}
}

export function lookupOf(tree: readonly Node[]): Lookup {
	const rest = partFrom(aroundResources(tree));
	const within = new Map<string, Part>();
	for (const node of rest.byId.values()) {
		if (!hasFile(node)) continue;
		const part = PARTS.get(node) ?? partFrom(nodesOf([node]));
		PARTS.set(node, part);
		within.set(node.file, part);
	}
	const partOf = (id: string): Part | undefined => within.get(id.split('#', 1)[0] ?? '');
	const get = (id: string): Node | undefined => partOf(id)?.byId.get(id) ?? rest.byId.get(id);
	function* values(): Generator<Node> {
		for (const node of rest.byId.values()) {
			const part = hasFile(node) ? within.get(node.file) : undefined;
			if (part) yield* part.byId.values();
			else yield node;
		}
	}
	return {
		byId: { get, has: (id) => get(id) !== undefined, values },
		parents: { get: (id) => partOf(id)?.parents.get(id) ?? rest.parents.get(id) }
	};
}

/** The nodes around `node`, from the outermost. */
export function around(lookup: Lookup, id: string): Node[] {
	const parent = lookup.parents.get(id);
	return parent ? [...around(lookup, parent.id), parent] : [];
}

/** The innermost node that the entry at `path` of `file` belongs to. */
export function nodeAt(lookup: Lookup, file: string, path: Path): Node | null {
	for (let length = path.length; length >= 0; length--) {
		const found = lookup.byId.get(idOf(file, path.slice(0, length)));
		if (found) return found;
	}
	return null;
}

/** Which part of the model it is, for what is asked and done by name; null for what has no such name. */
export function partOf(node: Node): string | null {
	const resource = node.owner ?? resourceOf(node.file);
	// What is in a type is named by an instance.
	if (resource === null && node.path.length > 0 && typeOf(node.file) !== null) return null;
	const own = (name: string): string => (resource === null ? name : `${resource}.${name}`);
	switch (node.kind) {
		case 'station':
		case 'section':
		case 'symbol':
		case 'shift':
		case 'scenario':
			return null;
		case 'variable':
		case 'ability':
		case 'flow':
		case 'alarm':
		case 'predicate':
			return `${node.kind}:${own(node.name)}`;
		case 'effect':
			return `effect:${own(String(node.path[1]))}.${node.name}`;
		default:
			return `${node.kind}:${node.name}`;
	}
}

/** Which part a parameter is that is named in an entry of `node`. */
export function parameterOf(node: Node, name: string): string | null {
	const [kind, ...rest] = (partOf(node) ?? '').split(':');
	const owner = rest.join(':');
	if (kind === 'effect' && node.words?.includes(name)) return `parameter:${owner}.${name}`;
	if (kind === 'effect') return `parameter:${owner.slice(0, owner.lastIndexOf('.'))}.${name}`;
	if (kind === 'ability' || kind === 'variable' || kind === 'predicate') return `parameter:${owner}.${name}`;
	const others: readonly (string | undefined)[] = ['operation', 'specification', 'sequence', 'work_master'];
	return others.includes(kind) ? `parameter:${kind}:${owner}.${name}` : null;
}

/** What has no form of fields: it is written as text. */
const WITHOUT_FORM: readonly string[] = ['section', 'symbol', 'shift', 'scenario', 'message'];

/** The shape of a node's document: what its form has. */
export function shapeOf(node: Node): string | null {
	if (WITHOUT_FORM.includes(node.kind)) return null;
	return node.kind === 'map' ? 'value_map' : node.kind;
}

/** A row of the tree as it is seen: how deep it is, and its place among its siblings. */
export interface Row {
	readonly node: Node;
	readonly level: number;
	readonly place: number;
	readonly siblings: number;
	readonly isOpen: boolean;
}

/** The full name of a node, as expressions have it: `robot.move`. */
const qualified = (node: Node): string | null => partOf(node)?.replace(/^\w+:/, '') ?? null;

/** The part that a name means, as conditions, findings and plans write it: without arguments, and without the flag. */
function partIn(words: string): string {
	const plain = words.replace(/\([^)]*\)?|\[[^\]]*\]?/g, '');
	return plain.replace(/^operation\./, '').replace(/\.(enabled|executing|finished|active)$/, '');
}

/** The rows that are in sight where the nodes in `open` are open; with `sought`, what fits it and what is around that. */
export function rowsOf(tree: readonly Node[], open: ReadonlySet<string>, sought: string): Row[] {
	const words = sought.trim().toLowerCase();
	const name = partIn(words);
	const has = (text: string | null | undefined, part: string): boolean => text?.toLowerCase().includes(part) ?? false;
	const fits = (node: Node): boolean =>
		node.kind !== 'section' &&
		([node.name, node.title, qualified(node)].some((text) => has(text, words)) || (name !== '' && has(qualified(node), name)));
	/** With what fits in it; with all that is in it where it fits itself. */
	const sift = (nodes: readonly Node[]): Node[] =>
		nodes.flatMap((node) => {
			if (fits(node)) return [node];
			const children = sift(node.children);
			return children.length > 0 ? [{ ...node, children }] : [];
		});
	const rows: Row[] = [];
	const add = (nodes: readonly Node[], level: number): void =>
		nodes.forEach((node, index) => {
			const isOpen = node.children.length > 0 && (open.has(node.id) || (words !== '' && !fits(node)));
			rows.push({ node, level, place: index + 1, siblings: nodes.length, isOpen });
			if (isOpen) add(node.children, level + 1);
		});
	add(words === '' ? tree : sift(tree), 1);
	return rows;
}
