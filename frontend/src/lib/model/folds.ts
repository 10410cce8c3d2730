/** What the draft could say shorter with the same meaning. */
import type { Folds } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import { request, type Answer } from '#lib/rest/request.ts';

/** Milliseconds in which the folds of a large model are proven. */
const PATIENCE = 60_000;

/** All folds there are, of the draft or of an example; or one, with another name for what it adds. */
export function foldsOf(example: string | null, one?: { readonly fold: string; readonly name: string }): Promise<Answer<Folds>> {
	return request('GET', askedOf('/api/v1/model/folds', example, Object.entries(one ?? {})), { patience: PATIENCE });
}
