/**
 * Which variables the list has, and in which order.
 *
 * What never changes of a variable is prepared once as an `Entry`: the text to search in, and its place in each order
 * that does not depend on values. What is left to do for thousands of them is to compare numbers.
 */
import type { StationView, Value, Variable } from '#lib/contract.ts';
import { variableName } from '#lib/wording/values.ts';
import { KINDS, OF_NONE, wordsOf, type Criteria, type SortedBy } from './criteria.ts';
import { standingIn, type Judged } from './standing.ts';

/** Puts a value of a variable, or that there is none, into words. */
type Said = (name: string, value: Value | null) => string;

export interface Entry {
	readonly name: string;
	readonly resource: string;
	readonly kind: Variable['kind'];
	/** What is searched in, but for the value, in small letters. */
	readonly text: string;
	/** The entry's place among all. */
	readonly byName: number;
	readonly byResource: number;
	readonly byKind: number;
}

const COLLATOR = new Intl.Collator(undefined, { numeric: true, sensitivity: 'base' });

/** The places of texts among them: the same for the same text. */
function ranks(texts: Iterable<string>): Map<string, number> {
	return new Map([...new Set(texts)].sort(COLLATOR.compare).map((text, rank) => [text, rank]));
}

/** The entries of all variables, by their names. */
export function entriesOf(
	{ variables, resources }: Pick<StationView, 'variables' | 'resources'>,
	called: (name: string, resource: string | null) => string,
	/** What resources are called in the list, where that is not their title. */
	shown: ReadonlyMap<string, string> = new Map()
): readonly Entry[] {
	const fullTitleOf = (resource: string | null): string =>
		resource === null ? '' : (resources[resource]?.title ?? resource);
	const titleOf = (resource: string | null): string => shown.get(resource ?? OF_NONE) ?? fullTitleOf(resource);
	const all = Object.entries(variables);
	const names = ranks(all.map(([name, { resource }]) => called(name, resource)));
	const titles = ranks(all.map(([, { resource }]) => titleOf(resource)));
	return all
		.map(([name, { resource, kind }]) => ({
			name,
			resource: resource ?? OF_NONE,
			kind,
			text: `${name} ${variableName(name, resource)} ${called(name, resource)} ${titleOf(resource)} ${fullTitleOf(resource)}`.toLocaleLowerCase(),
			byName: names.get(called(name, resource)) ?? 0,
			byResource: titles.get(titleOf(resource)) ?? 0,
			byKind: KINDS.indexOf(kind)
		}))
		.sort((one, other) => one.byName - other.byName);
}

/** Whether the list can be another as values change. */
export function followsValues({ search, only, sort }: Criteria): boolean {
	return wordsOf(search).length > 0 || only.length > 0 || sort === 'value' || sort === 'age';
}

/** The names of the variables that `criteria` ask for, in their order. `said` puts a value, or that there is none, into words. */
export function arrange(
	entries: readonly Entry[],
	criteria: Criteria,
	view: Judged,
	said: Said
): readonly string[] {
	const { resource, kind, only, sort, down } = criteria;
	const words = wordsOf(criteria.search);
	const valueText = (name: string, value: Value | null): string => `${value ?? ''} ${said(name, value)}`.toLocaleLowerCase();
	const has = standingIn(view);
	const found = entries.filter((entry) => {
		if (resource !== '' && entry.resource !== resource) return false;
		if (kind !== '' && entry.kind !== kind) return false;
		const variable = view.variables[entry.name];
		if (variable === undefined) return false;
		if (only.length > 0 && !only.some((standing) => has(entry.name, variable, standing))) return false;
		return words.every((word) => entry.text.includes(word) || valueText(entry.name, variable.value).includes(word));
	});
	const keyOf = keys(found, sort, view, said);
	const sign = down ? -1 : 1;
	return found
		.map((entry) => ({ entry, key: keyOf(entry) }))
		.sort(
			(one, other) =>
				sign * (one.key - other.key) ||
				one.entry.byResource - other.entry.byResource ||
				one.entry.byKind - other.entry.byKind ||
				one.entry.byName - other.entry.byName
		)
		.map(({ entry }) => entry.name);
}

/** What entries are sorted by, as numbers. */
function keys(
	entries: readonly Entry[],
	sort: SortedBy,
	{ variables }: Judged,
	said: Said
): (entry: Entry) => number {
	switch (sort) {
		case 'name':
			return (entry) => entry.byName;
		case 'resource':
			return (entry) => entry.byResource;
		case 'kind':
			return (entry) => entry.byKind;
		case 'age':
			// The youngest first: that is what one looks for.
			return (entry) => -(variables[entry.name]?.since ?? -Infinity);
		case 'value': {
			const places = placesOf(
				entries.map(({ name }) => {
					const value = variables[name]?.value ?? null;
					return { name, key: typeof value === 'number' ? value : said(name, value), known: value !== null };
				})
			);
			return (entry) => places.get(entry.name) ?? 0;
		}
	}
}

interface Sorted {
	readonly name: string;
	readonly key: number | string;
	readonly known: boolean;
}

/** The places of variables by their values: numbers by their size, then words, then what is unknown; the same for the same. */
function placesOf(all: Sorted[]): Map<string, number> {
	const group = ({ key, known }: Sorted): number => (!known ? 2 : typeof key === 'number' ? 0 : 1);
	const compare = (one: Sorted, other: Sorted): number =>
		group(one) - group(other) ||
		(typeof one.key === 'number' && typeof other.key === 'number'
			? one.key - other.key
			: COLLATOR.compare(String(one.key), String(other.key)));
	const places = new Map<string, number>();
	let place = 0;
	all.sort(compare).forEach((each, index) => {
		const before = all[index - 1];
		if (before !== undefined && compare(before, each) !== 0) place += 1;
		places.set(each.name, place);
	});
	return places;
}
