import { describe, expect, test } from 'vitest';
import swedish from '#lib/text/sv/fields.json';
import { PARTS } from './documents.ts';

const sentences = new Set(
	Object.values(PARTS)
		.flatMap(({ about, fields }) => [about, ...Object.values(fields).map(({ help }) => help)])
		.filter((text) => text !== '')
);
const codes = (text: string): string[] => (text.match(/`[^`]*`/g) ?? []).sort();

describe('what fields and parts are for', () => {
	test('is said in Swedish, all of it and nothing else', () => {
		expect(Object.keys(swedish).sort()).toEqual([...sentences].sort());
	});

	test('names the same keys and values in Swedish', () => {
		for (const [english, told] of Object.entries(swedish)) expect(codes(told), english).toEqual(codes(english));
	});
});
