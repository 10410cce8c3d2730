/** Arrows between operations, and groups of them, as they are written: sequences in `operations.yaml`. */
import type { DraftOperations, Edit, OperationLink } from '#lib/contract.ts';
import { isMapping, type Json } from '#lib/model/content.ts';

export const OPERATIONS = 'operations.yaml';

/** How several operations are put together: one behind the other, or beside one another. */
export const TOGETHER = ['sequence', 'parallel', 'arbitrary', 'alternative'] as const satisfies readonly ('sequence' | DraftOperations['groups'][number]['kind'])[];
export type Together = (typeof TOGETHER)[number];

/** A sequence that is written as a list, and for nothing else. */
interface Listed {
	readonly name: string;
	readonly steps: readonly Json[];
}

/** One that is a list of operations alone, one after another. */
interface Plain extends Listed {
	readonly steps: readonly string[];
}

function listedOnes(content: Json | undefined): Listed[] {
	if (!isMapping(content)) return [];
	return Object.entries(content).flatMap(([name, entry]): Listed[] => {
		if (!isMapping(entry) || !('sequence' in entry) || 'for' in entry) return [];
		const { sequence } = entry;
		return Array.isArray(sequence) ? [{ name, steps: sequence }] : [];
	});
}

function plainOnes(content: Json | undefined): Plain[] {
	return listedOnes(content).filter((each): each is Plain => each.steps.every((step) => typeof step === 'string'));
}

/** The edits by which `after` comes behind `before`: a sequence that ends or begins with one of them grows, or there is a new one. */
export function drawn(content: Json | undefined, before: string, after: string): Edit[] {
	return inOrder(content, [before, after]);
}

/** The edits by which operations come one behind the other, as they are given. */
function inOrder(content: Json | undefined, names: readonly string[]): Edit[] {
	const plain = plainOnes(content);
	const grown = (name: string, was: readonly string[], value: readonly string[]): Edit[] => [
		{ kind: 'set', file: OPERATIONS, path: [name, 'sequence'], was: [...was], value: [...value] }
	];
	const [first, ...later] = names;
	const ending = plain.find(({ steps }) => steps.at(-1) === first && !later.some((each) => steps.includes(each)));
	if (ending) return grown(ending.name, ending.steps, [...ending.steps, ...later]);
	const earlier = names.slice(0, -1);
	const beginning = plain.find(({ steps }) => steps[0] === names.at(-1) && !earlier.some((each) => steps.includes(each)));
	if (beginning) return grown(beginning.name, beginning.steps, [...earlier, ...beginning.steps]);
	return [added(content, nameOf('then', names), { sequence: [...names] })];
}

/** What stands between the first two in the name of a new group. */
const BETWEEN = { sequence: 'then', parallel: 'with', arbitrary: 'and', alternative: 'or' } as const satisfies Record<Together, string>;

/**
 * The edits by which operations are put together: those that follow on one another in one list are put beside one another in
 * their place there, and others in a new sequence.
 */
export function grouped(content: Json | undefined, how: Together, names: readonly string[]): Edit[] {
	if (how === 'sequence') return inOrder(content, names);
	const listed = following(content, names);
	if (listed === null) return [added(content, nameOf(BETWEEN[how], names), { [how]: [...names] })];
	const { name, steps, at } = listed;
	const value = [...steps.slice(0, at), { [how]: [...names] }, ...steps.slice(at + names.length)];
	return [{ kind: 'set', file: OPERATIONS, path: [name, 'sequence'], was: [...steps], value }];
}

/** The list in which just these follow on one another, in whatever order, and where in it; null where there is none. */
export function following(content: Json | undefined, names: readonly string[]): (Listed & { readonly at: number }) | null {
	for (const listed of listedOnes(content)) {
		const at = listed.steps.findIndex((step) => names.includes(step as string));
		const run = listed.steps.slice(at, at + names.length);
		if (at !== -1 && run.length === names.length && names.every((name) => run.includes(name))) return { ...listed, at };
	}
	return null;
}

/** The edits that take an arrow out; null where something else than a plain sequence says that order too. */
export function erased(content: Json | undefined, { before, after, reasons }: OperationLink): Edit[] | null {
	const plain = new Map(plainOnes(content).map((each) => [each.name, each]));
	const edits: Edit[] = [];
	let known = content;
	for (const { kind, name } of reasons) {
		const sequence = kind === 'sequence' ? plain.get(name) : undefined;
		const at = sequence?.steps.indexOf(before) ?? -1;
		if (sequence === undefined || at === -1 || sequence.steps[at + 1] !== after) return null;
		const [head, tail] = [sequence.steps.slice(0, at + 1), sequence.steps.slice(at + 1)];
		const kept = head.length > 1 ? head : tail.length > 1 ? tail : null;
		const entry = isMapping(content) ? content[name] : undefined;
		if (kept === null) edits.push({ kind: 'remove', file: OPERATIONS, path: [name], was: entry ?? null });
		else edits.push({ kind: 'set', file: OPERATIONS, path: [name, 'sequence'], was: [...sequence.steps], value: [...kept] });
		if (kept === head && tail.length > 1) {
			const more = added(known, `${name}_2`, { sequence: [...tail] });
			edits.push(more);
			if (isMapping(known) && 'path' in more) known = { ...known, [String(more.path[0])]: {} };
		}
	}
	return edits;
}

/** A new sequence, under a name that is not taken yet. */
function added(content: Json | undefined, wanted: string, value: { [key: string]: Json }): Edit {
	const taken = new Set(isMapping(content) ? Object.keys(content) : []);
	let name = wanted;
	for (let number = 2; taken.has(name); number += 1) name = `${wanted}_${number}`;
	return { kind: 'add', file: OPERATIONS, path: [name], value, before: null, after: null };
}

function nameOf(between: string, names: readonly string[]): string {
	return names
		.slice(0, 2)
		.map(entryOf)
		.join(`_${between}_`);
}

/** What an operation is written under, without what stands for its parameters. */
function entryOf(name: string): string {
	return name.split('(')[0] ?? name;
}
