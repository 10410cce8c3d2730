/** The picture of an instruction with the state of the station in it: a drawing of which parts have the names of values. */
import type { StationView } from '#lib/contract.ts';

type Variables = Readonly<Record<string, Pick<StationView['variables'][string], 'value'>>>;

/** `bolts` and `pair_1` of `engine.bolts[pair_1]`. */
const INDEXED = /(?:^|\.)(\w+)\[([^\],]+)\]$/;

/**
 * The drawing with the value of each indexed variable at the element that has its index as `id`: of `bolts[pair_1]` the one with
 * `id="pair_1"` has it in `data-bolts`. Null where no element is of any.
 */
export function withState(svg: string, variables: Variables): string | null {
	let drawn = svg;
	for (const [name, { value }] of Object.entries(variables)) {
		const [, array, index] = INDEXED.exec(name) ?? [];
		if (array === undefined || index === undefined || value === null) continue;
		const element = new RegExp(`(<[A-Za-z][^<>]*?\\sid=)(["'])${escaped(index)}\\2`);
		drawn = drawn.replace(element, (found) => `${found} data-${array}="${attribute(String(value))}"`);
	}
	return drawn === svg ? null : drawn;
}

const escaped = (text: string): string => text.replaceAll(/[^\w]/g, '\\$&');
const attribute = (text: string): string => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');

/** The same as the address of a picture, with the part of it that is marked. */
export function asAddress(svg: string, part: string): string {
	return `data:image/svg+xml,${encodeURIComponent(svg)}${part === '' ? '' : `#${part}`}`;
}
