/** What the files of a model hold: values by their paths, whatever somebody has written there. */
import type { Json as Contract } from '#lib/contract.ts';
import { inLanguage } from '#lib/text/text.svelte.ts';

/** The contract says only that it is some JSON value. */
export type Json = null | boolean | number | string | readonly Json[] | { readonly [name: string]: Json };
export type Path = readonly (string | number)[];

/** The same value as one that is not known any closer, and back. */
export const asJson = (value: Contract): Json => value as Json;

export function isMapping(value: Json | undefined): value is { readonly [name: string]: Json } {
	return typeof value === 'object' && value !== null && !Array.isArray(value);
}

export function isList(value: Json | undefined): value is readonly Json[] {
	return Array.isArray(value);
}

/** The names in a mapping and what is behind them; none where it is no mapping. */
export function entriesOf(value: Json | undefined): [string, Json][] {
	return isMapping(value) ? Object.entries(value) : [];
}

/** The value at `path`; undefined where there is none. */
export function valueAt(content: Json | undefined, path: Path): Json | undefined {
	let value = content;
	for (const step of path) {
		if (isList(value) && typeof step === 'number') value = value[step];
		else if (isMapping(value) && Object.hasOwn(value, step)) value = value[step];
		else return undefined;
	}
	return value;
}

/** Whether two values are equal, the order of names included: it is kept in files, and means something to people. */
export function same(one: Json | undefined, other: Json | undefined): boolean {
	return JSON.stringify(one) === JSON.stringify(other);
}

/** The text at `path`; null where there is none. */
export function textAt(content: Json | undefined, path: Path): string | null {
	const value = valueAt(content, path);
	return typeof value === 'string' ? value : null;
}

/** The title at `path`, in a language where it is written by language; null where there is none. */
export function titleAt(content: Json | undefined, path: Path, language: string): string | null {
	const value = valueAt(content, path);
	const texts = entriesOf(value).filter((entry): entry is [string, string] => typeof entry[1] === 'string');
	return texts.length > 0 ? inLanguage(Object.fromEntries(texts), language) : textAt(content, path);
}

/** A path as people write it: `abilities.run_nut.start.do[0]`. */
export function shownPath(path: Path): string {
	let written = '';
	for (const step of path) {
		if (typeof step === 'number') written += `[${step}]`;
		else {
			const name = /^[^\s.[\]"']+$/.test(step) ? step : `"${step}"`;
			written += written === '' ? name : `.${name}`;
		}
	}
	return written;
}
