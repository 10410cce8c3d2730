/** What can be done with several parts at once: what is in the way, and the edits that do it as one change. */
import type { Edit } from '#lib/contract.ts';
import { free, sectionOf } from './clipboard.ts';
import type { Yaml } from './commented.ts';
import { isList, isMapping, valueAt, type Json, type Path } from './content.ts';
import { copied, copiedAt, removed } from './making.ts';
import { around, type Lookup, type Node } from './tree.ts';

type Contents = Readonly<Record<string, Json | undefined>>;
export const DEEDS = ['copy', 'cut', 'duplicate', 'remove', 'move'] as const;
export type Deed = (typeof DEEDS)[number];

/** Why something cannot be done with parts as they are chosen: because of `node`, without which it may be. */
export interface Hindrance {
	readonly why: 'heading' | 'within' | 'typed' | 'message' | 'locked' | 'twice' | 'mixed' | 'unordered' | 'apart';
	readonly node: Node;
	/** What it does not go with. */
	readonly other: Node | null;
}

/** A resource or a type, which is a file of its own. */
const isWhole = ({ kind }: Node): boolean => kind === 'resource' || kind === 'type';

/** The first that is in the way; null where nothing is. Each way leads from what is kept to what would be left out. */
export function hindrance(deed: Deed, nodes: readonly Node[], lookup: Lookup, locked: (file: string) => boolean): Hindrance | null {
	const chosen = new Set(nodes.map(({ id }) => id));
	const names = new Map<string, Node>();
	const [first] = nodes;
	for (const node of nodes) {
		const hinders = (why: Hindrance['why'], other: Node | null = null): Hindrance => ({ why, node, other });
		if (node.kind === 'section' || node.kind === 'station') return hinders('heading');
		const above = around(lookup, node.id).find(({ id }) => chosen.has(id));
		if (above) return hinders('within', above);
		if (deed !== 'copy' && (node.file.startsWith('packages/') || (node.path.length > 0 && locked(node.file)))) return hinders('locked');
		if (deed !== 'remove' && node.of !== undefined) return hinders('typed');
		if (node.kind === 'message' && deed !== 'remove') return hinders(deed === 'move' ? 'unordered' : 'message');
		if (deed === 'move') {
			if (node.path.length === 0) return hinders('unordered');
			if (first && !isBeside(first, node)) return hinders('apart', first);
		}
		if (deed !== 'copy' && deed !== 'cut') continue;
		if (first && isWhole(first) !== isWhole(node)) return hinders('mixed', first);
		const name = `${sectionOf(node) ?? ''} ${node.name}`;
		const same = names.get(name);
		if (same) return hinders('twice', same);
		names.set(name, node);
	}
	return null;
}

/** Those with which it can be done, and all that would be in the way, one after the other. */
export function fitting(
	deed: Deed,
	nodes: readonly Node[],
	lookup: Lookup,
	locked: (file: string) => boolean
): { readonly fit: readonly Node[]; readonly hindrances: readonly Hindrance[] } {
	let fit = nodes;
	const hindrances: Hindrance[] = [];
	for (let found = hindrance(deed, fit, lookup, locked); found; found = hindrance(deed, fit, lookup, locked)) {
		const { node } = found;
		hindrances.push(found);
		fit = fit.filter((each) => each !== node);
	}
	return { fit, hindrances };
}

/** Whether two stand in the same list of the same file. */
export function isBeside(one: Node, other: Node): boolean {
	if (one.file !== other.file || one.path.length !== other.path.length) return false;
	return one.path.slice(0, -1).every((step, depth) => other.path[depth] === step);
}

/** Whether it has a place among others that can be another one. */
export const isOrdered = (node: Node): boolean => node.kind !== 'section' && node.path.length > 0 && node.of === undefined;

/** Edits that take all of them out, each made from what those before have left. */
export function removedAll(nodes: readonly Node[], contents: Contents, text: (file: string) => string): Edit[] {
	const left: Record<string, Json | undefined> = { ...contents };
	return nodes.flatMap((node) => {
		const edits = removed(node, left[node.file], text(node.file));
		left[node.file] = edits.reduce(after, left[node.file]);
		return edits;
	});
}

/** Edits that make a copy of each beside it, and where these are found; their names are free. */
export function duplicatedAll(
	nodes: readonly Node[],
	lookup: Lookup,
	contents: Contents,
	text: (file: string) => string,
	yaml: Yaml | null
): { readonly edits: readonly Edit[]; readonly at: readonly { readonly file: string; readonly path: Path }[]; readonly names: readonly string[] } {
	const given = new Map<Node | undefined, Set<string>>();
	const made = nodes.map((node) => {
		const parent = lookup.parents.get(node.id);
		const taken = given.get(parent) ?? new Set((parent?.children ?? []).map(({ name }) => name));
		given.set(parent, taken);
		const name = free(node.name, (each) => taken.has(each));
		taken.add(name);
		return { name, edits: copied(node, name, contents[node.file], text(node.file), yaml), at: copiedAt(node, name) };
	});
	return { edits: made.flatMap(({ edits }) => edits), at: made.map(({ at }) => at), names: made.map(({ name }) => name) };
}

/** Where parts are put among their siblings: before or after one of them. */
export interface Target {
	readonly node: Node;
	readonly where: 'before' | 'after';
}

/** Edits that put parts beside one of their siblings, in their order; none where they stand so already. */
export function movedTo(nodes: readonly Node[], { node: target, where }: Target, siblings: readonly Node[], content: Json | undefined): Edit[] {
	const list = siblings.filter((each) => isOrdered(each) && isBeside(each, target));
	const moving = list.filter(({ id }) => nodes.some((each) => each.id === id));
	const rest = list.filter((each) => !moving.includes(each));
	const at = rest.findIndex(({ id }) => id === target.id);
	if (moving.length === 0 || at < 0) return [];
	const order = rest.toSpliced(where === 'before' ? at : at + 1, 0, ...moving);
	if (order.every((each, place) => each === list[place])) return [];
	return moving.map((node, place) => {
		const [last] = place === 0 ? [target] : moving.slice(place - 1);
		const beside = String(last?.path.at(-1));
		const was = valueAt(content, node.path) ?? null;
		return { kind: 'move', file: node.file, path: [...node.path], was, ...(place === 0 && where === 'before' ? { before: beside } : { after: beside }) };
	});
}

/** Where parts come to stand that go one up or down among the siblings in sight; null where they are at the end. */
export function oneOn(nodes: readonly Node[], siblings: readonly Node[], by: 1 | -1): Target | null {
	const [first] = nodes;
	if (!first) return null;
	const list = siblings.filter((each) => isOrdered(each) && isBeside(each, first));
	const places = list.flatMap((each, place) => (nodes.some(({ id }) => id === each.id) ? [place] : []));
	const from = by < 0 ? Math.min(...places) : Math.max(...places);
	const node = list[from + by];
	return node ? { node, where: by < 0 ? 'before' : 'after' } : null;
}

/** What a file holds after an edit of it. */
export function after(content: Json | undefined, edit: Edit): Json | undefined {
	if (edit.kind === 'text' || edit.kind === 'move') return content;
	const within = (value: Json | undefined, [step, ...rest]: Path): Json | undefined => {
		if (step === undefined) return edit.kind === 'remove' ? undefined : (edit.value as Json);
		if (isList(value)) {
			const [at, now] = [Number(step), within(value[Number(step)], rest)];
			return now === undefined ? value.toSpliced(at, 1) : value.with(at, now);
		}
		const { [step]: was, ...others } = isMapping(value) ? value : {};
		const now = within(was, rest);
		if (now === undefined) return others;
		return isMapping(value) ? { ...value, [step]: now } : { [step]: now };
	};
	return within(content, edit.path);
}

/** What parts are called together: the first of them, and how many more. */
export function fewOf(names: readonly string[], more: (n: number) => string, most = 5): string {
	const shown = names.slice(0, most).join(', ');
	return names.length > most ? `${shown} ${more(names.length - most)}` : shown;
}
