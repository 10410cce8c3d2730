import { expect, test } from 'vitest';
import type { Finding } from '#lib/contract.ts';
import { addressOf, groupsOf, placeOf } from './groups.ts';

function finding(kind: string, file: string, line = 1, message = 'It is so'): Finding {
	return { severity: kind === 'unusable' ? 'error' : 'warning', kind, file, line, column: 3, message, said: null, members: [], trace: null, fixes: [] };
}

const FOUND = [
	finding('never-read', 'a.yaml'),
	finding('goal-lost', 'b.yaml', 4),
	finding('goal-lost', 'b.yaml', 4),
	finding('always-holds', 'b.yaml')
];

test('they are grouped by kind, the gravest first', () => {
	expect(groupsOf(FOUND, 'kind').map(({ of, listed }) => [of, listed.length])).toEqual([
		['goal-lost', 2],
		['always-holds', 1],
		['never-read', 1]
	]);
});

test('they are grouped by file, those with errors first', () => {
	const all = [...FOUND, finding('unusable', 'c.yaml')];
	expect(groupsOf(all, 'file').map(({ of, listed }) => [of, listed.length])).toEqual([
		['c.yaml', 1],
		['a.yaml', 1],
		['b.yaml', 3]
	]);
});

test('each has a key of its own, which stays while more is found', () => {
	const keys = (all: Finding[]): string[] => groupsOf(all, 'file').flatMap(({ listed }) => listed.map(({ key }) => key));
	expect(new Set(keys(FOUND)).size).toBe(FOUND.length);
	const more = keys([finding('never-starts', 'a.yaml'), ...FOUND, finding('never-active', 'z.yaml')]);
	expect(more).toEqual(expect.arrayContaining(keys(FOUND)));
});

test('a place is told as an editor does, and leads to the model', () => {
	const one = finding('never-read', 'resources/robot arm.yaml', 12);
	expect(placeOf(one)).toBe('resources/robot arm.yaml:12:3');
	expect(addressOf(one)).toBe('/model?file=resources%2Frobot+arm.yaml&line=12');
});
