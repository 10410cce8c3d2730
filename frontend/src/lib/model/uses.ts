/** Where a part of the model is named, and what could not be without it. */
import type { Finding } from '#lib/contract.ts';
import { request, type Answer } from '#lib/rest/request.ts';

export interface Usage {
	readonly file: string;
	readonly path: readonly (string | number)[];
	readonly line: number;
	readonly column: number;
	readonly length: number;
	readonly written: string;
	/** It is where the part is declared. */
	readonly declares: boolean;
	/** The part in which it is named. */
	readonly used_by: string;
}

export interface Usages {
	readonly usages: readonly Usage[];
	readonly dependants: readonly Usage[];
	/** Texts that hold the name and make no sense. */
	readonly unread: readonly Finding[];
	/** Why the name is not the model's alone; null where it is. */
	readonly bound: string | null;
}

/** Milliseconds in which all files of a large model are looked through. */
const PATIENCE = 20_000;

/** Where the part is named. */
export function usagesOf(part: string): Promise<Answer<Usages>> {
	return request('GET', `/api/v1/model/usages?${new URLSearchParams({ part })}`, { patience: PATIENCE });
}
