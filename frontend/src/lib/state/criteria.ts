/** Which variables the list has, and in which order; kept in the query of the page's address, so that it can be linked to. */
import type { VariableKind } from '#lib/contract.ts';
import { STANDINGS, type Standing } from './standing.ts';

export const KINDS = ['measured', 'output', 'estimated'] as const satisfies readonly VariableKind[];

/** What the list can be sorted by. */
export const SORTED_BY = ['name', 'value', 'resource', 'kind', 'age'] as const;
export type SortedBy = (typeof SORTED_BY)[number];

/** Stands for the variables that belong to no resource; no resource can be called so. */
export const OF_NONE = '-';

export interface Criteria {
	/** Words, all of which are in a row, wherever. */
	readonly search: string;
	/** The resource, or empty for all. */
	readonly resource: string;
	readonly kind: VariableKind | '';
	/** Those of one of these standings, or all where there is none. */
	readonly only: readonly Standing[];
	readonly sort: SortedBy;
	/** The other way round. */
	readonly down: boolean;
}

export const EVERYTHING: Criteria = { search: '', resource: '', kind: '', only: [], sort: 'resource', down: false };

/** The words that are searched for. */
export function wordsOf(search: string): string[] {
	return search.toLocaleLowerCase().split(/\s+/).filter(Boolean);
}

/** What an address asks for; what it says otherwise counts for nothing. */
export function criteriaOf(query: Pick<URLSearchParams, 'get'>): Criteria {
	const sort = query.get('sort') ?? '';
	const by = sort.replace(/^-/, '');
	const only = (query.get('only') ?? '').split(',');
	return {
		search: query.get('search') ?? '',
		resource: query.get('resource') ?? '',
		kind: KINDS.find((kind) => kind === query.get('kind')) ?? '',
		only: STANDINGS.filter((standing) => only.includes(standing)),
		sort: SORTED_BY.find((each) => each === by) ?? EVERYTHING.sort,
		down: sort.startsWith('-')
	};
}

/** The query that asks for it, with its question mark; empty where it asks for everything. */
export function queryOf({ search, resource, kind, only, sort, down }: Criteria): string {
	const query = new URLSearchParams();
	if (search.trim() !== '') query.set('search', search.trim());
	if (resource !== '') query.set('resource', resource);
	if (kind !== '') query.set('kind', kind);
	if (only.length > 0) query.set('only', only.join(','));
	if (sort !== EVERYTHING.sort || down) query.set('sort', `${down ? '-' : ''}${sort}`);
	return query.size === 0 ? '' : `?${query}`;
}

/** Sorted by `sort`; by what it is sorted by already, the other way round, and then by resource again. */
export function sortedBy(criteria: Criteria, sort: SortedBy): Criteria {
	if (criteria.sort !== sort) return { ...criteria, sort, down: false };
	return criteria.down ? { ...criteria, sort: EVERYTHING.sort, down: false } : { ...criteria, down: true };
}
