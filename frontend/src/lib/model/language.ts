/** What the server knows of the language of conditions and actions: the only authority on it. */
import { request } from '#lib/rest/request.ts';
import type { Path } from './content.ts';

/** Where an expression stands. */
export interface Spot {
	readonly file: string;
	readonly path: Path;
}

/** Something wrong in an expression, from one character to another. */
export interface Wrong {
	readonly start: number;
	readonly end: number;
	readonly message: string;
}

export interface Option {
	readonly label: string;
	readonly insert: string;
	readonly kind: string;
	readonly detail: string;
}

export interface Completion {
	readonly from: number;
	readonly to: number;
	readonly options: readonly Option[];
}

export interface Hover {
	readonly start: number;
	readonly end: number;
	readonly name: string;
	readonly kind: string;
	readonly type: string | null;
	readonly initial: unknown;
	readonly declared: { readonly file: string; readonly line: number; readonly column: number } | null;
}

async function ask<Value>(what: string, body: object): Promise<Value | null> {
	const answer = await request<Value>('POST', `/api/v1/model/language/${what}`, { body });
	return answer.ok ? answer.value : null;
}

/** What is wrong with it; null where the server did not say. */
export async function wrongIn(spot: Spot, text: string): Promise<readonly Wrong[] | null> {
	return (await ask<{ problems: readonly Wrong[] }>('check', { ...spot, text }))?.problems ?? null;
}

/** What could stand at `offset`; null where nothing is known. */
export function completionOf(spot: Spot, text: string, offset: number): Promise<Completion | null> {
	return ask('completion', { ...spot, text, offset });
}

/** What is named at `offset`; null where nothing is. */
export function hoverOf(spot: Spot, text: string, offset: number): Promise<Hover | null> {
	return ask('hover', { ...spot, text, offset });
}

/** The same in its usual form; null where it has none. */
export async function formatted(spot: Spot, text: string): Promise<string | null> {
	return (await ask<{ text: string }>('format', { ...spot, text }))?.text ?? null;
}
