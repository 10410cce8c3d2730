/**
 * What the server knows of the language of conditions and actions: the only authority on it.
 *
 * It counts the characters of a text, where this page counts units of UTF-16.
 */
import type { Message, Value } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import { request } from '#lib/rest/request.ts';
import { told } from '#lib/text/message.ts';
import type { Path } from './content.ts';

/** Where an expression stands. */
export interface Spot {
	/** The example that it stands in; nothing for the draft. */
	readonly example?: string | null;
	readonly file: string;
	readonly path: Path;
}

/** Part of a text. */
interface Span {
	readonly start: number;
	readonly end: number;
}

/** Something wrong in a text. */
export interface Wrong extends Span {
	readonly message: string;
}

export interface Option {
	readonly label: string;
	readonly insert: string;
	readonly kind: string;
	readonly detail: string;
}

/** What can stand in place of a part of a text, the most useful first. */
export interface Completion extends Span {
	readonly options: readonly Option[];
}

/** What a name is; `names` are the full names of what it can stand for. */
export interface Hover extends Span {
	readonly name: string;
	readonly kind: string;
	readonly names: readonly string[];
	readonly type: string | null;
	readonly domain: readonly Value[];
	readonly initial: Value | null;
	readonly title: string | null;
	/** The condition that it was given, where it is written for short. */
	readonly definition: string | null;
	/** What it stands for in the end. */
	readonly expansion: string | null;
	/** The id by which it is looked for in the model; null for a parameter. */
	readonly part: string | null;
	readonly declared: { readonly file: string; readonly line: number; readonly column: number } | null;
}

const counted = (text: string, offset: number): number => [...text.slice(0, offset)].length;
const placed = (text: string, offset: number): number => [...text].slice(0, offset).join('').length;

/** With its places as this page counts them. */
function here<Found extends Span>(text: string, found: Found): Found {
	return { ...found, start: placed(text, found.start), end: placed(text, found.end) };
}

interface Problem extends Wrong {
	readonly said: Message | null;
}

/** Milliseconds in which a text is looked at, the first time after a change of a large model. */
const PATIENCE = 20_000;

async function ask<Value>(what: 'check' | 'completion' | 'format' | 'hover', { example = null, file, path }: Spot, asked: object): Promise<Value | null> {
	const body = { file, path, ...asked };
	const answer = await request<Value>('POST', askedOf(`/api/v1/model/language/${what}`, example), { body, patience: PATIENCE });
	return answer.ok ? answer.value : null;
}

/** What is wrong with it; null where the server did not say. */
export async function wrongIn(spot: Spot, text: string): Promise<readonly Wrong[] | null> {
	const answer = await ask<{ problems: readonly Problem[] }>('check', spot, { text });
	return answer === null ? null : answer.problems.map((each) => ({ ...here(text, each), message: told(each.said, each.message) }));
}

/** What could stand at `offset`; null where nothing is known. */
export async function completionOf(spot: Spot, text: string, offset: number): Promise<Completion | null> {
	const answer = await ask<Completion>('completion', spot, { text, offset: counted(text, offset) });
	return answer === null ? null : here(text, answer);
}

/** What is named at `offset`; null where nothing is. */
export async function hoverOf(spot: Spot, text: string, offset: number): Promise<Hover | null> {
	const answer = await ask<{ hover: Hover | null }>('hover', spot, { text, offset: counted(text, offset) });
	return answer === null || answer.hover === null ? null : here(text, answer.hover);
}

/** The same in its usual form; null where the server did not say. */
export async function formatted(spot: Spot, text: string): Promise<string | null> {
	return (await ask<{ text: string }>('format', spot, { text }))?.text ?? null;
}
