/** Parts of a model as they go through the clipboard: YAML, each by its name below the section in which files have it. */
import type { Edit } from '#lib/contract.ts';
import { commentedAt, pairAt, type Yaml } from './commented.ts';
import { isMapping, same, valueAt, type Json } from './content.ts';
import { ownFile, placesAt, type Place } from './making.ts';
import { around, SCENARIOS, type Lookup, type Node } from './tree.ts';

type Contents = Readonly<Record<string, Json | undefined>>;

/** The section of a part, as it stands above it; null for what is no entry of a file, such as a message. */
export function sectionOf({ kind, file, path }: Node): string | null {
	if (kind === 'resource') return 'resources';
	if (kind === 'type') return 'types';
	if (kind === 'section' || kind === 'station' || kind === 'message' || path.length === 0) return null;
	const above = path.at(-2);
	if (typeof above === 'string') return above;
	return file === SCENARIOS || file.startsWith('tests/') ? 'tests' : file.replace(/\.yaml$/, '');
}

/** Parts as one text, each below its section and with the comments of its file; null where one of them is written nowhere by itself. */
export function partsText(nodes: readonly Node[], contents: Contents, textOf: (file: string) => string, yaml: Yaml): string | null {
	const all: Record<string, Record<string, Json>> = {};
	const written = new yaml.Document({});
	for (const node of nodes) {
		const [section, value] = [sectionOf(node), valueAt(contents[node.file], node.path)];
		if (section === null || value === undefined || node.of !== undefined) return null;
		(all[section] ??= {})[node.name] = value;
		const pair = node.path.length > 0 ? pairAt(yaml, textOf(node.file), node.path) : null;
		if (!written.has(section)) written.set(section, new yaml.YAMLMap());
		const below = written.get(section);
		if (yaml.isMap(below)) below.add(pair ?? written.createPair(node.name, value));
	}
	const text = written.toString({ lineWidth: 0, flowCollectionPadding: false });
	return same(yaml.parse(text) as Json, all) ? text : yaml.stringify(all);
}

/** What would be pasted: the edits, where each part is found then, and what they are called. */
export interface Pasted {
	readonly edits: readonly Edit[];
	readonly at: readonly { readonly file: string; readonly path: readonly (string | number)[] }[];
	readonly names: readonly string[];
}

/** Why nothing can be pasted: it is no part of a model, or `section` has no place where one is. */
export type NotPasted = { readonly section: string | null };

/** Pastes parts at a node: into the resource around it where they belong to one, under names that are free. */
export function pastedAt(text: string, node: Node | null, lookup: Lookup, contents: Contents, yaml: Yaml): Pasted | NotPasted {
	let read: unknown;
	try {
		read = yaml.parse(text);
	} catch {
		return { section: null };
	}
	const sections = isMapping(read as Json) ? Object.entries(read as Record<string, Json>) : [];
	const parts = sections.flatMap(([section, entries]) => (isMapping(entries) ? Object.entries(entries).map(([name, value]) => ({ section, name, value })) : [null]));
	if (parts.length === 0) return { section: null };
	const places = placesAt(node, node ? around(lookup, node.id) : []);
	const taken = new Set<string>();
	const edits: Edit[] = [];
	const found: { file: string; path: string[] }[] = [];
	const names: string[] = [];
	for (const part of parts) {
		if (part === null) return { section: null };
		const { section, value } = part;
		const place = places.find((each) => each.section === section || each.path?.at(-1) === section);
		if (!place || place.kind === 'message') return { section };
		const name = free(part.name, (each) => taken.has(`${section} ${each}`) || isTaken(each, place, contents));
		taken.add(`${section} ${name}`);
		names.push(name);
		if (place.path === null) {
			const file = ownFile(place.kind, name);
			if (!isMapping(value)) return { section: null };
			edits.push(...Object.entries(value).map(([key, inner]): Edit => ({ kind: 'add', file, path: [key], value: inner })));
			found.push({ file, path: [] });
		} else {
			const commented = commentedAt(yaml, text, [section, part.name], value);
			edits.push({ kind: 'add', file: place.file, path: [...place.path, name], value, ...(commented !== null && { text: commented }) });
			found.push({ file: place.file, path: [...place.path.map(String), name] });
		}
	}
	return edits.length === 0 ? { section: null } : { edits, at: found, names };
}

function isTaken(name: string, { kind, file, path }: Place, contents: Contents): boolean {
	if (path === null) return contents[ownFile(kind, name)] !== undefined;
	const there = valueAt(contents[file], path);
	return isMapping(there) && Object.hasOwn(there, name);
}

export function free(name: string, taken: (name: string) => boolean): string {
	if (!taken(name)) return name;
	for (let n = 2; ; n++) if (!taken(`${name}_${n}`)) return `${name}_${n}`;
}
