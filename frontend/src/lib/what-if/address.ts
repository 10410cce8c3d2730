/** Which view of *What-if* is looked at, as it stands in its address. */

export const VIEWS = ['steps', 'simulation', 'space'] as const;
export type View = (typeof VIEWS)[number];

/** The view that a query asks for: by its name, or else by what only one of them shows. */
export function viewIn(query: Pick<URLSearchParams, 'get' | 'has'>): View {
	const named = VIEWS.find((view) => view === query.get('view'));
	if (named !== undefined) return named;
	if (['record', 'scenario', 'simulation'].some((key) => query.has(key))) return 'simulation';
	return query.has('space') ? 'space' : 'steps';
}

/** The same address with another view, and what each of them began with. */
export function besideView(address: Iterable<[string, string]>, view: View): string {
	const query = new URLSearchParams([...address].filter(([key]) => !['view', 'simulation', 'space'].includes(key)));
	query.set('view', view);
	return `/what-if?${query}`;
}
