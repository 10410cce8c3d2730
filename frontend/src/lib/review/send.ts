/** What is asked of the server about revisions, and what is done with them. */
import type { Comments, Comparison, FilesView, Revision, Simulation, Transfer, Value, Verdict, WhatIf, WhatIfBody } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { command, request, type Answer } from '#lib/rest/request.ts';

const ADDRESS = '/api/v1/model';
/** Milliseconds for what the server works at for up to a minute. */
const LONG = 70_000;
/** Milliseconds in which the files of a large model are written. */
const WRITING = 20_000;

/** Saves the draft after its change `number`. 409: it was changed since; 422: the name cannot be used. */
export function saveRevision(number: number, name: string, message: string): Promise<Answer<Revision>> {
	return request('POST', `${ADDRESS}/revisions`, { body: { number, name, message }, patience: WRITING });
}

/** Lets the draft, after its change `number`, become a revision again. */
export function restoreRevision(number: number, id: string): Promise<Answer<FilesView>> {
	return request('POST', `${ADDRESS}/revisions/${id}/restore`, { body: { number }, patience: WRITING });
}

/** How two versions differ, as far as that is known within so many seconds: ids of revisions, `draft` or `running`. */
export function compare(old: string, newer: string, writtenOnly: boolean, wait: number, asked: AbortSignal): Promise<Answer<Comparison>> {
	const signal = AbortSignal.any([asked, AbortSignal.timeout(LONG)]);
	const query = new URLSearchParams({ old, new: newer, wait: String(wait), written_only: String(writtenOnly) });
	return request('GET', `${ADDRESS}/comparison?${query}`, { signal });
}

/** How the station would go on for so many seconds with a version of the model from these values on. */
export function simulate(version: string, seconds: number, present: Record<string, Value | null>, asked: AbortSignal): Promise<Answer<WhatIf>> {
	const signal = AbortSignal.any([asked, AbortSignal.timeout(LONG)]);
	return request('POST', `${ADDRESS}/what-if`, { body: { version, seconds, present } satisfies WhatIfBody, signal });
}

/** Whether the station could take the draft as it is now, or with the simulation reset. Nothing is changed by asking. */
export function findTransfer(simulation: Simulation): Promise<Answer<Transfer>> {
	return request('GET', `${ADDRESS}/transfer?${new URLSearchParams({ simulation })}`, { patience: LONG });
}

/** Lets a revision, which the draft is after its change `number`, take the place of the model that runs. */
export function deployRevision(
	revision: string,
	number: number,
	reason: string,
	simulation: Simulation
): Promise<Refusal | null> {
	return command('POST', `${ADDRESS}/deployments`, {
		body: { revision, number, reason, simulation },
		patience: LONG
	});
}

/** The same when the product in work is done. 409: it could not be deployed now either, or the model tells no product's end. */
export function planDeployment(revision: string, number: number, reason: string, simulation: Simulation): Promise<Refusal | null> {
	return command('PUT', `${ADDRESS}/deployments/planned`, { body: { revision, number, reason, simulation }, patience: LONG });
}

/** Nothing is deployed when the product is done; the station pauses then all the same. */
export function cancelDeployment(): Promise<Refusal | null> {
	return command('DELETE', `${ADDRESS}/deployments/planned`);
}

/** Says something of the draft. */
export function addComment(text: string): Promise<Answer<Comments['comments'][number]>> {
	return request('POST', `${ADDRESS}/comments`, { body: { text } });
}

/** Says what one thinks of a revision. 403: one has saved it oneself. */
export function reviewRevision(id: string, verdict: Verdict, text: string): Promise<Answer<Comments['comments'][number]>> {
	return request('POST', `${ADDRESS}/revisions/${id}/reviews`, { body: { verdict, text } });
}
