/** Of many parts, how many are how far: for where they cannot be read one by one. */
import type { MimicPart } from '#lib/contract.ts';
import { partValue } from './describe.ts';
import { lookOf, type Look, type Variables } from './live.ts';

/** From so many on they are counted where there is no room to read them. */
export const MANY = 16;

export interface Counted {
	readonly look: Look;
	/** What the value is called. */
	readonly text: string;
	readonly count: number;
}

const ORDER: readonly Look[] = ['doubt', 'empty', 'placed', 'done'];

/** How many parts have which value: what is done comes last, as what is made comes to it. */
export function countedParts(parts: readonly MimicPart[], variables: Variables, language: string): Counted[] {
	const found = new Map<string, Counted>();
	for (const part of parts) {
		const [look, text] = [lookOf(part, variables), partValue(part, variables, language)];
		found.set(`${look} ${text}`, { look, text, count: (found.get(`${look} ${text}`)?.count ?? 0) + 1 });
	}
	return [...found.values()].sort((a, b) => ORDER.indexOf(a.look) - ORDER.indexOf(b.look) || b.count - a.count);
}
