/** What the draft could say shorter with the same meaning. */
import type { Folds } from '#lib/contract.ts';
import { request, type Answer } from '#lib/rest/request.ts';

/** Milliseconds in which the folds of a large model are proven. */
const PATIENCE = 60_000;

/** All folds there are; or one, with another name for what it adds. */
export function foldsOf(one?: { readonly fold: string; readonly name: string }): Promise<Answer<Folds>> {
	return request('GET', one ? `/api/v1/model/folds?${new URLSearchParams(one)}` : '/api/v1/model/folds', {
		patience: PATIENCE
	});
}
