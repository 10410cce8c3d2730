/** Where a part of the model is named, and what could not be without it. */
import type { Usages } from '#lib/contract.ts';
import { request, type Answer } from '#lib/rest/request.ts';

/** Milliseconds in which all files of a large model are looked through. */
const PATIENCE = 20_000;

/** Where the part is named. */
export function usagesOf(part: string): Promise<Answer<Usages>> {
	return request('GET', `/api/v1/model/usages?${new URLSearchParams({ part })}`, { patience: PATIENCE });
}
