/** What a person looks at in the graph of Model, as it stands in the page's address. */
import { exampleIn, shownAt } from '#lib/examples/address.ts';
import type { Filter } from './bands.ts';

export interface Looked extends Filter {
	/** The example station that is looked at; null for the draft. */
	readonly example: string | null;
	/** The id of what is chosen; null for nothing. */
	readonly thing: string | null;
	/** How many steps away something may be to be shown as tied to it. */
	readonly steps: number;
	/** Whether what is tied to nothing is marked. */
	readonly loose: boolean;
}

/** From the goal of an operation over a variable, an ability and an output to a topic. */
export const USUAL_STEPS = 4;
export const STEPS: readonly number[] = [1, 2, USUAL_STEPS, Infinity];

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const steps = query.get('steps') === 'all' ? Infinity : Number(query.get('steps'));
	return {
		example: exampleIn(query),
		thing: query.get('thing') || null,
		steps: STEPS.includes(steps) ? steps : USUAL_STEPS,
		loose: query.get('loose') === 'on',
		resource: query.get('resource') ?? '',
		kind: query.get('kind') ?? ''
	};
}

export function addressOf({ thing, steps, loose, resource, kind, example = null }: Partial<Looked>): string {
	const query = new URLSearchParams({ view: 'graph' });
	if (thing) query.set('thing', thing);
	if (steps !== undefined && steps !== USUAL_STEPS) query.set('steps', steps === Infinity ? 'all' : String(steps));
	if (loose) query.set('loose', 'on');
	if (resource) query.set('resource', resource);
	if (kind) query.set('kind', kind);
	return shownAt('/model', example, query);
}
