/** What a thing is tied to, in words: by the manner of the tie, each with the places where it is written. */
import type { ModelTie } from '#lib/contract.ts';
import { leadsUp, withInside, type Manner, type Thing, type Whole } from './graph.ts';

/** In which order manners are listed: what matters most first. */
const MANNERS: readonly Manner[] = [
	'runs', 'after', 'brings', 'goal', 'precondition', 'formula', 'forbids', 'excludes', 'orders', 'zone', 'rest',
	'commands', 'writes', 'effect', 'feeds', 'sends', 'guard', 'progress', 'acknowledgement', 'expects', 'reads',
	'source', 'carries', 'ranges', 'names', 'example'
];

/** Another thing to which the chosen one is tied in some manner. */
export interface Other {
	readonly thing: Thing;
	/** Which part of the chosen thing, or of the other, it is about, where that is not the whole. */
	readonly part: string | null;
	readonly places: readonly ModelTie[];
}

export interface Manners {
	readonly manner: Manner;
	/** The chosen thing is the one that is used. */
	readonly isUsed: boolean;
	readonly others: readonly Other[];
}

export interface Uses {
	readonly up: readonly Manners[];
	readonly down: readonly Manners[];
}

interface Group {
	readonly isUp: boolean;
	readonly manner: Manner;
	readonly isUsed: boolean;
	readonly others: Map<string, Other & { readonly places: ModelTie[] }>;
}

/** All ties of a thing with what is no part of it. */
export function usesOf(whole: Whole, index: number): Uses {
	const own = new Set(withInside(whole, index));
	const groups = new Map<string, Group>();
	function add(tie: ModelTie, isUsed: boolean): void {
		const mine = isUsed ? tie.thing : tie.by;
		const theirs = isUsed ? tie.by : tie.thing;
		if (own.has(theirs)) return;
		const thing = whole.things[theirs];
		// With each name of something that it has, a resource is named as well.
		if (thing === undefined || (!isUsed && thing.kind === 'resource')) return;
		const isUp = leadsUp(whole, tie) === isUsed;
		const key = `${isUp} ${tie.manner} ${isUsed}`;
		const group = groups.get(key) ?? { isUp, manner: tie.manner, isUsed, others: new Map() };
		groups.set(key, group);
		const part = mine === index ? null : (whole.things[mine]?.name ?? null);
		const name = `${theirs} ${part ?? ''}`;
		const other = group.others.get(name) ?? { thing, part, places: [] };
		group.others.set(name, other);
		other.places.push(tie);
	}
	for (const each of own) {
		for (const tie of whole.usedBy[each] ?? []) add(tie, true);
		for (const tie of whole.uses[each] ?? []) add(tie, false);
	}
	const all = [...groups.values()]
		.map(({ others, ...group }) => ({ ...group, others: [...others.values()] }))
		.sort((one, other) => MANNERS.indexOf(one.manner) - MANNERS.indexOf(other.manner));
	return { up: all.filter(({ isUp }) => isUp), down: all.filter(({ isUp }) => !isUp) };
}

/** Things whose name or title has all of the words, the likeliest first. */
export function foundBy(whole: Whole, sought: string): Thing[] {
	const words = sought.toLowerCase().split(/\s+/).filter(Boolean);
	if (words.length === 0) return [];
	const last = (name: string): string => name.slice(Math.max(name.lastIndexOf('.'), name.lastIndexOf('/')) + 1);
	const rank = ({ name, within }: Thing): number => {
		const [short, full] = [last(name.toLowerCase()), name.toLowerCase()];
		const word = words[0] ?? '';
		const near = full === word || short === word ? 0 : short.startsWith(word) ? 1 : full.includes(word) ? 2 : 3;
		return near * 2 + (within === null ? 0 : 1);
	};
	return whole.things
		.filter(({ name, title }) => {
			const text = `${name} ${title ?? ''}`.toLowerCase();
			return words.every((word) => text.includes(word));
		})
		.sort((one, other) => rank(one) - rank(other) || one.name.localeCompare(other.name));
}
