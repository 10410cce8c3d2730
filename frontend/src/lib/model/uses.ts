/** Where a part of the model is used, and how it is renamed everywhere. */
import type { Edit } from '#lib/contract.ts';
import { request, type Answer } from '#lib/rest/request.ts';

export interface Usage {
	readonly file: string;
	readonly path: readonly (string | number)[];
	readonly line: number;
	readonly column: number;
	readonly length: number;
	readonly written: string;
	/** Where it is, in words. */
	readonly where: string;
}

/** Calls a part otherwise, wherever it is named. */
export interface Rename {
	readonly kind: 'rename';
	readonly part: string;
	readonly name: string;
}

export type AnyEdit = Edit | Rename;

/** Where the part is named. */
export function usagesOf(part: string): Promise<Answer<{ usages: readonly Usage[] }>> {
	return request('GET', `/api/v1/model/usages?part=${encodeURIComponent(part)}`);
}
