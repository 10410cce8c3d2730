/** What is made, copied, moved and taken away: each as the edits that do it. */
import type { Edit } from '#lib/contract.ts';
import { capital } from '#lib/wording/capital.ts';
import { commentedAt, type Yaml } from './commented.ts';
import { isList, isMapping, same, shownPath, valueAt, type Json, type Path } from './content.ts';
import { SPECIFICATIONS } from './specification.ts';
import { typeFile } from './types.ts';
import { SCENARIOS, IN_RESOURCE, messageFile, STATION, type EntryKind, type InResource, type Node } from './tree.ts';

/** Where something can be made: below which path of which file, and what. */
export interface Place {
	readonly kind: EntryKind;
	readonly file: string;
	/** The mapping that it becomes an entry of; null for a file of its own. */
	readonly path: Path | null;
	/** The section it stands in, by which its place is told from others of the same kind. */
	readonly section: string;
}

/** Where something can be made at a node, what is nearest first. */
export function placesAt(node: Node | null, around: readonly Node[]): Place[] {
	const isWhole = (each: Node): boolean => each.kind === 'resource' || each.kind === 'type';
	const resource = node && isWhole(node) ? node : around.find(isWhole);
	const ability = node?.kind === 'ability' ? node : around.find((each) => each.kind === 'ability');
	const inAbility: Place[] = ability
		? [{ kind: 'effect', file: ability.file, path: [...ability.path, 'effects'], section: 'effects' }]
		: [];
	const inResource: Place[] = resource
		? (Object.keys(IN_RESOURCE) as InResource[]).map((key) => {
				return { kind: IN_RESOURCE[key], file: resource.file, path: [key], section: key };
			})
		: [];
	const elsewhere: Place[] = [
		{ kind: 'resource', file: '', path: null, section: 'resources' },
		{ kind: 'type', file: '', path: null, section: 'types' },
		{ kind: 'enumeration', file: STATION, path: ['enumerations'], section: 'enumerations' },
		{ kind: 'set', file: STATION, path: ['sets'], section: 'sets' },
		{ kind: 'relation', file: STATION, path: ['relations'], section: 'relations' },
		{ kind: 'map', file: STATION, path: ['maps'], section: 'maps' },
		{ kind: 'variable', file: STATION, path: ['estimated'], section: 'variables' },
		{ kind: 'predicate', file: STATION, path: ['predicates'], section: 'station_predicates' },
		{ kind: 'alarm', file: STATION, path: ['alarms'], section: 'station_alarms' },
		{ kind: 'operation', file: 'operations.yaml', path: [], section: 'operations' },
		{ kind: 'sequence', file: 'operations.yaml', path: [], section: 'operations' },
		{ kind: 'specification', file: 'specifications.yaml', path: [], section: 'specifications' },
		{ kind: 'work_master', file: 'work_masters.yaml', path: [], section: 'work_masters' },
		{ kind: 'shift', file: 'shifts.yaml', path: [], section: 'shifts' },
		{ kind: 'scenario', file: SCENARIOS, path: [], section: 'tests' },
		{ kind: 'message', file: '', path: null, section: 'messages' }
	];
	const all = [...inAbility, ...inResource, ...elsewhere];
	const here = [node, ...around.toReversed()].flatMap((each) => (each ? [each] : []));
	const nearest = here
		.map((each) => all.find((place) => (each.kind === 'section' ? place.section === each.name : place.kind === each.kind)))
		.find((place) => place !== undefined);
	return nearest === undefined ? all : [nearest, ...all.filter((place) => place !== nearest)];
}

const inWords = (name: string): string => capital(name.replaceAll('_', ' ').trim());

/** What something begins as; `given` is what was asked for beside its name. */
export function beginning(kind: EntryKind, name: string, given: Readonly<Record<string, Json>>): Json {
	const title = { title: inWords(name) };
	switch (kind) {
		case 'variable':
			return { type: 'bool', ...given };
		case 'ability':
			return { ...title, enabled: false };
		case 'alarm':
			return { ...title, when: false };
		case 'predicate':
			return { ...title, when: false };
		case 'effect':
			return { kind: 'executing', when: false, do: [], ...given };
		case 'operation':
			return { ...title, precondition: false, goal: true };
		case 'sequence':
			return { ...title, sequence: [] };
		case 'specification':
			return { ...title, ...(Object.keys(given).length > 0 ? given : SPECIFICATIONS.forbidden) };
		case 'work_master':
			return { ...title, operations: {} };
		case 'shift':
			return { ...title, from: '06:00', to: '14:00', days: ['mon', 'tue', 'wed', 'thu', 'fri'] };
		case 'scenario':
			return { ...title, steps: [{ holds: true }] };
		case 'resource':
		case 'type':
			return { ...given, ...title };
		case 'enumeration':
			return given['values'] ?? given;
		default:
			return given;
	}
}

/** The file of a resource, or of a type of some. */
export const ownFile = (kind: 'resource' | EntryKind, name: string): string =>
	kind === 'type' ? typeFile(name) : `resources/${name}.yaml`;

/** Edits that make it. */
export function made(place: Place, name: string, given: Readonly<Record<string, Json>>): Edit[] {
	const value = beginning(place.kind, name, given);
	if (place.kind === 'message') return [{ kind: 'text', file: messageFile(name), was: null, text: '' }];
	if (place.path === null)
		return Object.entries(isMapping(value) ? value : {}).map(([key, inner]) => {
			return { kind: 'add', file: ownFile(place.kind, name), path: [key], value: inner };
		});
	return [{ kind: 'add', file: place.file, path: [...place.path, name], value }];
}

/** Where it would be found that was made there. */
export function madeAt(place: Place, name: string): { file: string; path: Path } {
	if (place.kind === 'message') return { file: messageFile(name), path: [] };
	if (place.path === null) return { file: ownFile(place.kind, name), path: [] };
	return { file: place.file, path: [...place.path, name] };
}

/** Edits that make another one like it, called `name`; with the comments in it, where there is what reads them. */
export function copied(node: Node, name: string, content: Json | undefined, text: string, yaml: Yaml | null): Edit[] {
	if (node.kind === 'resource' || node.kind === 'type') return [{ kind: 'text', file: ownFile(node.kind, name), was: null, text }];
	if (node.kind === 'message') return [{ kind: 'text', file: messageFile(name), was: null, text }];
	const value = valueAt(content, node.path) ?? null;
	const commented = yaml && commentedAt(yaml, text, node.path, value);
	return [{ kind: 'add', file: node.file, path: [...node.path.slice(0, -1), name], value, after: node.name, ...(commented !== null && { text: commented }) }];
}

/** Where a copy would be found. */
export function copiedAt(node: Node, name: string): { file: string; path: Path } {
	if (node.kind === 'resource' || node.kind === 'type') return { file: ownFile(node.kind, name), path: [] };
	if (node.kind === 'message') return { file: messageFile(name), path: [] };
	return { file: node.file, path: [...node.path.slice(0, -1), name] };
}

/** Edits that take it out; with the last of its kind its section goes too. */
export function removed(node: Node, content: Json | undefined, text: string): Edit[] {
	if (node.path.length === 0) return [{ kind: 'text', file: node.file, was: text, text: null }];
	if (node.of === undefined) return taken(node.file, content, node.path, 0);
	// It is the type's: the instance says that it has none.
	const list = valueAt(content, ['remove']);
	const path = shownPath(node.path);
	if (isList(list)) return [{ kind: 'set', file: node.file, path: ['remove'], was: list, value: [...list, path] }];
	return [{ kind: 'add', file: node.file, path: ['remove'], value: [path] }];
}

/** Edits that take the entry at `path` out, and what has nothing in it then, as far as it is deeper than `keep` steps. */
export function taken(file: string, content: Json | undefined, path: Path, keep: number): Edit[] {
	let at = path;
	while (at.length - 1 > keep) {
		const parent = valueAt(content, at.slice(0, -1));
		const size = typeof parent === 'object' && parent !== null ? Object.keys(parent).length : 0;
		if (size > 1) break;
		at = at.slice(0, -1);
	}
	return [{ kind: 'remove', file, path: [...at], was: valueAt(content, at) ?? null }];
}

/** Edits that let the entry at `path` be `value` that was `was`; undefined is no entry. `keep` as in `taken`. */
export function written(
	file: string,
	content: Json | undefined,
	path: Path,
	was: Json | undefined,
	value: Json | undefined,
	keep: number
): Edit[] {
	if (same(was, value)) return [];
	if (was === undefined) return value === undefined ? [] : [{ kind: 'add', file, path: [...path], value }];
	if (value !== undefined) return [{ kind: 'set', file, path: [...path], was, value }];
	const edits = taken(file, content, path, keep);
	const [only] = edits;
	// Somebody may have changed it since: what was seen is what is taken out.
	return only?.kind === 'remove' && only.path.length === path.length ? [{ ...only, was }] : edits;
}
