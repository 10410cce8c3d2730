/** What a person looks at on the page Operations, as it stands in its address. */
export const VIEWS = ['sequence', 'time', 'table'] as const;
export type View = (typeof VIEWS)[number];

export interface Looked {
	readonly view: View;
	/** The operation that is chosen; null for none. */
	readonly operation: string | null;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const wanted = query.get('view');
	return { view: VIEWS.find((view) => view === wanted) ?? 'sequence', operation: query.get('operation') };
}

export function addressOf({ view, operation }: Looked): string {
	const query = new URLSearchParams();
	if (view !== 'sequence') query.set('view', view);
	if (operation !== null) query.set('operation', operation);
	return query.size === 0 ? '/operations' : `/operations?${query}`;
}
