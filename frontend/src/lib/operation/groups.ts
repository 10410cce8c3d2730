/** Operations that differ in nothing but a parameter are told as one, with how many of them are done. */
import type { Operation } from '#lib/contract.ts';

export type Named = readonly [name: string, operation: Operation];

export interface Group {
	/** What is called so, without its parameters. */
	readonly name: string;
	readonly title: string;
	/** One for what has no parameters, or is the only one of its kind. */
	readonly members: readonly Named[];
}

/** What stands in the parentheses of a name; empty where it has no parameters. */
export const parametersOf = (name: string): string => /\((.*)\)$/.exec(name)?.[1] ?? '';

/** All operations in groups, each at the place of its first; `plural` makes of a word that of several. */
export function groupsOf(operations: Readonly<Record<string, Operation>>, plural = (word: string): string => word): Group[] {
	const groups = new Map<string, Named[]>();
	for (const named of Object.entries(operations)) {
		const name = named[0].split('(')[0] ?? named[0];
		const members = groups.get(name);
		if (members) members.push(named);
		else groups.set(name, [named]);
	}
	return [...groups].map(([name, members]) => ({
		name,
		title: titleOf(
			members.map(([, { title }]) => title),
			name,
			plural
		),
		members
	}));
}

/** What titles have in common, with what is different between: `Tighten pairs 1–6`, `Load … into the rack`. */
function titleOf(titles: readonly string[], name: string, plural: (word: string) => string): string {
	const [first = name, ...rest] = titles;
	if (rest.length === 0) return first;
	const words = titles.map((title) => title.split(' '));
	const fewest = Math.min(...words.map(({ length }) => length));
	const same = (at: (of: readonly string[]) => string | undefined): boolean => words.every((of) => at(of) === at(words[0] ?? []));
	let before = 0;
	while (before < fewest && same((of) => of[before])) before++;
	let after = 0;
	while (after < fewest - before && same((of) => of.at(-1 - after))) after++;
	const head = words[0]?.slice(0, before) ?? [];
	const tail = after === 0 ? [] : (words[0]?.slice(-after) ?? []);
	if (head.length + tail.length === 0) return name.replaceAll('_', ' ');
	const what = between(words.map((of) => of.slice(before, of.length - after).join(' ')));
	const last = head.at(-1);
	// A word of a sentence, and no name: several of it are counted.
	if (what.includes('–') && last !== undefined && /^\p{Ll}+$/u.test(last)) head.splice(-1, 1, plural(last));
	return [...head, what, ...tail].filter(Boolean).join(' ');
}

/** Numbers that follow one another are told by the first and the last. */
function between(parts: readonly string[]): string {
	if (parts.every((part) => part === '')) return '';
	const numbers = parts.map((part) => (/^\d+$/.test(part) ? Number(part) : NaN));
	const follow = numbers.every((number, index) => index === 0 || number === (numbers[index - 1] ?? NaN) + 1);
	return follow && !Number.isNaN(numbers[0]) ? `${parts[0]}–${parts.at(-1)}` : '…';
}
