import { describe, expect, it } from 'vitest';
import { countedParts } from './counted.ts';

type Parameter = Parameters<typeof countedParts>;

const parts = Array.from({ length: 20 }, (_, n) => ({
	variable: `bolts[${n}]`,
	titles: { tight: { en: 'tight' }, empty: { en: 'empty' } },
	looks: { empty: 'empty', tight: 'done' }
})) as unknown as Parameter[0];
const variables = Object.fromEntries(
	parts.map(({ variable }, n) => [variable, { value: n < 3 ? 'tight' : n < 19 ? 'empty' : null }])
) as unknown as Parameter[1];

describe('many parts', () => {
	it('are counted by how far they are, and what is not known is not left out', () => {
		expect(countedParts(parts, variables, 'en')).toEqual([
			{ look: 'doubt', text: 'unknown', count: 1 },
			{ look: 'empty', text: 'empty', count: 16 },
			{ look: 'done', text: 'tight', count: 3 }
		]);
	});
});
