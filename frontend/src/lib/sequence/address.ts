/** What a person looks at on the page Operations, as it stands in its address. */
import { exampleIn, shownAt } from '#lib/examples/address.ts';

export const VIEWS = ['sequence', 'time', 'table'] as const;
export type View = (typeof VIEWS)[number];

export interface Looked {
	readonly view: View;
	/** The operation that is chosen; null for none. */
	readonly operation: string | null;
	/** The example station that is looked at; null for the draft. */
	readonly example: string | null;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const wanted = query.get('view');
	return { view: VIEWS.find((view) => view === wanted) ?? 'sequence', operation: query.get('operation'), example: exampleIn(query) };
}

export function addressOf({ view, operation, example }: Looked): string {
	return shownAt('/operations', example, { ...(view !== 'sequence' && { view }), ...(operation !== null && { operation }) });
}
