/** Where a part of the model is named, and what could not be without it. */
import type { Usages } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import { request, type Answer } from '#lib/rest/request.ts';

/** Milliseconds in which all files of a large model are looked through. */
const PATIENCE = 20_000;

/** Where the part is named, in the draft or in an example. */
export function usagesOf(part: string, example: string | null): Promise<Answer<Usages>> {
	return request('GET', askedOf('/api/v1/model/usages', example, [['part', part]]), { patience: PATIENCE });
}
