/** What a person looks at on the page ROS, as it stands in its address. */
import type { Search } from './rows.ts';

export const LISTS = ['topics', 'nodes', 'services', 'actions'] as const;
export type List = (typeof LISTS)[number];

const SHOWS = ['all', 'station', 'wrong'] as const;

export interface Looked extends Search {
	/** The topic that is chosen. */
	readonly topic: string | null;
	readonly list: List;
}

/** What the query of an address asks for; what it cannot mean is left out. */
export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	return {
		topic: query.get('topic') || null,
		text: query.get('search') ?? '',
		resource: query.get('resource') || null,
		show: SHOWS.find((show) => show === query.get('show')) ?? 'all',
		list: LISTS.find((list) => list === query.get('list')) ?? 'topics'
	};
}

/** The address that asks for it. */
export function addressOf(looked: Partial<Looked>): string {
	const query = new URLSearchParams();
	if (looked.topic) query.set('topic', looked.topic);
	if (looked.text) query.set('search', looked.text);
	if (looked.resource) query.set('resource', looked.resource);
	if (looked.show !== undefined && looked.show !== 'all') query.set('show', looked.show);
	if (looked.list !== undefined && looked.list !== 'topics') query.set('list', looked.list);
	return query.size === 0 ? '/ros' : `/ros?${query}`;
}
