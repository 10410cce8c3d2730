/** What is asked of the server about revisions, and what is done with them. */
import type { Comparison, FilesView, Revision, Simulation, Transfer } from '#lib/contract.ts';
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

/** How two versions differ: ids of revisions, `draft` or `running`. */
export function compare(old: string, newer: string): Promise<Answer<Comparison>> {
	return request('GET', `${ADDRESS}/comparison?${new URLSearchParams({ old, new: newer })}`, { patience: LONG });
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
