import fc from 'fast-check';
import { expect, test } from 'vitest';
import { operation } from '#lib/testing/view.ts';
import { groupsOf } from './groups.ts';

const titled = (...all: [string, string][]): Record<string, ReturnType<typeof operation>> =>
	Object.fromEntries(all.map(([name, title]) => [name, operation({ title })]));

test('operations that differ in a parameter alone are one group at the place of the first', () => {
	const groups = groupsOf(
		titled(['identify', 'Identify'], ['place(p1)', 'Place pair 1'], ['place(p2)', 'Place pair 2'], ['leave', 'Leave'], ['place(p3)', 'Place pair 3']),
		(word) => `${word}s`
	);
	expect(groups.map(({ name, title, members }) => [name, title, members.length])).toEqual([
		['identify', 'Identify', 1],
		['place', 'Place pairs 1–3', 3],
		['leave', 'Leave', 1]
	]);
});

test('a group is called by what the titles have in common', () => {
	const titleOf = (...titles: string[]): string | undefined => groupsOf(titled(...titles.map((title, k): [string, string] => [`do_it(${k})`, title])))[0]?.title;
	expect(titleOf('Place pair 4')).toBe('Place pair 4');
	expect(titleOf('Load blue into the rack', 'Load red into the rack')).toBe('Load … into the rack');
	expect(titleOf('Skruva par 2 hårt', 'Skruva par 3 hårt')).toBe('Skruva par 2–3 hårt');
	expect(titleOf('Place pair 2', 'Place pair 4')).toBe('Place pair …');
	expect(titleOf('Load', 'Load')).toBe('Load');
	expect(titleOf('Left', 'Right')).toBe('do it');
	expect(titleOf('Load', 'Load again')).toBe('Load …');
});

test('every operation is in one group, in the order of the model', () => {
	const name = fc.tuple(fc.constantFrom('a', 'b', 'c'), fc.option(fc.integer({ min: 0, max: 9 }))).map(([base, k]) => (k === null ? base : `${base}(${k})`));
	fc.assert(
		fc.property(fc.uniqueArray(name), fc.string(), (names, title) => {
			const groups = groupsOf(titled(...names.map((each): [string, string] => [each, title])));
			expect(groups.flatMap(({ members }) => members.map(([each]) => each)).sort()).toEqual([...names].sort());
			for (const { members } of groups) {
				const places = members.map(([each]) => names.indexOf(each));
				expect(places).toEqual([...places].sort((a, b) => a - b));
			}
		})
	);
});
