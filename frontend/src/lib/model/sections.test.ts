import { describe, expect, test } from 'vitest';
import { PARTS } from './documents.ts';
import { FLAT, isDivided, sectionsOf, toldFields } from './sections.ts';

const label = (key: string): string => key.toUpperCase();
const told = (written: Parameters<typeof toldFields>[0]): string => toldFields(written, label, 'en');

describe('the sections of a form', () => {
	test('have each field of an ability once, but for what the tree has', () => {
		const fields = Object.entries(PARTS['ability']?.fields ?? {}).flatMap(([key, { kind }]) => (kind === 'parts' ? [] : [key]));
		const keys = (sectionsOf('ability', fields) ?? []).flatMap((each) => each.keys);
		expect(keys.toSorted()).toEqual(fields.toSorted());
		for (const each of FLAT) expect(PARTS['ability']?.fields[each]?.kind).toBe('part');
	});

	test('are only those in which something is', () => {
		expect(sectionsOf('ability', ['start', 'title'])).toEqual([{ name: 'what', keys: ['title'] }, { name: 'start', keys: ['start'] }]);
		expect(sectionsOf('variable', ['type'])).toBeNull();
		expect(isDivided('variable')).toBe(false);
	});

	test('tell folded what is written in them', () => {
		expect(told([['title', { en: 'Move', sv: 'Kör' }], ['duration', [2, 4]], ['timeouts', { react: 5, finish: 40 }]])).toBe('Move · 2 – 4 s · TIMEOUTS: REACT 5, FINISH 40');
		expect(told([['enabled', 'a and\n  b'], ['start', { when: 'c', do: ['d := e', 'f := g'] }]])).toBe('a and b · WHEN c, d := e, f := g');
		expect(told([['enabled', true], ['restart', true], ['moves', false], ['until', undefined]])).toBe('ENABLED · RESTART · MOVES: false');
		expect(told([['human', { task: { en: 'Take it.', sv: 'Ta den.' }, acknowledgement: 'done' }]])).toBe('Take it., ACKNOWLEDGEMENT done');
		expect(told([['late', { not_begun: { en: 'It stays.', sv: 'Den står.' }, not_finished: 'It is slow.' }]])).toBe('LATE: It stays., It is slow.');
		expect(told([['duration', 3], ['title', '']])).toBe('3');
	});
});
