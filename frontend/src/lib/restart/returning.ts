/** How far a resource is that is to come back: it is out of service, silent, not understood, or back. */
import type { OutOfService, StationView } from '#lib/contract.ts';
import { outOf } from '#lib/service/out.ts';

export type Returning =
	| { readonly how: 'out'; readonly out: OutOfService }
	| { readonly how: 'awaited' | 'senseless'; readonly topics: readonly string[] }
	| { readonly how: 'back' };

/** One that was taken out of service is put back by a press; one that is silent or talks nonsense is noticed by itself. */
export function returning(view: StationView, name: string): Returning {
	const out = outOf(view.out_of_service, 'resource', name);
	if (out) return { how: 'out', out };
	const awaited = view.resources[name]?.awaited_topics ?? [];
	if (awaited.length > 0) return { how: 'awaited', topics: awaited };
	const senseless = Object.entries(view.topics).flatMap(([topic, { resource, direction, trouble }]) =>
		resource === name && direction === 'in' && trouble !== null ? [topic] : []
	);
	return senseless.length > 0 ? { how: 'senseless', topics: senseless } : { how: 'back' };
}
