import { describe, expect, test } from 'vitest';
import { numbersText } from './numbers.ts';
import { readSrdf, type Group } from './srdf.ts';

const joint = (name: string, value: string): string => `<joint name="${name}" value="${value}"/>`;
const state = (name: string, group: string, ...joints: string[]): string => `<group_state name="${name}" group="${group}">${joints.join('')}</group_state>`;
const robot = (...children: string[]): string => `<?xml version="1.0"?>\n<robot name="ur"><group name="arm"/>${children.join('\n')}</robot>`;

function groupsIn(text: string): readonly Group[] {
	const read = readSrdf(text);
	if ('what' in read) throw new Error(read.what);
	return read;
}

describe('the group states of an SRDF', () => {
	test('are given by group, each with its joints in the order of the first', () => {
		const [arm, hand, ...more] = groupsIn(
			robot(
				state('home', 'arm', joint('pan', '0'), joint('lift', '-1.57')),
				state('open', 'hand', joint('finger', '0.04')),
				state('up', 'arm', joint('lift', '-1.2'), joint('pan', '0.6'))
			)
		);
		expect(more).toEqual([]);
		expect(arm).toEqual({
			name: 'arm',
			joints: ['pan', 'lift'],
			states: [
				{ name: 'home', joints: [0, -1.57], wrong: null },
				{ name: 'up', joints: [0.6, -1.2], wrong: null }
			]
		});
		expect(hand?.states.map(({ name }) => name)).toEqual(['open']);
	});

	test('are found wherever they stand, and a joint may have several numbers', () => {
		const [group] = groupsIn(robot(`<xacro:macro name="x">${state('home', 'base', joint('floating', ' 0 0  1.5 '))}</xacro:macro>`));
		expect(group?.states).toEqual([{ name: 'home', joints: [0, 0, 1.5], wrong: null }]);
	});

	test('say what keeps one from being a pose', () => {
		const [group] = groupsIn(
			robot(
				state('first', 'arm', joint('a', '1'), joint('b', '2')),
				state('', 'arm', joint('a', '1'), joint('b', '2')),
				state('fewer', 'arm', joint('a', '1')),
				state('others', 'arm', joint('a', '1'), joint('c', '2')),
				state('words', 'arm', joint('a', '${pi}'), joint('b', '2')),
				state('nothing', 'arm', joint('a', ''), joint('b', '2')),
				state('endless', 'arm', joint('a', 'Infinity'), joint('b', '2'))
			)
		);
		expect(group?.states.map(({ wrong }) => wrong)).toEqual([
			null,
			{ what: 'name' },
			{ what: 'missing', joint: 'b' },
			{ what: 'other', joint: 'c' },
			{ what: 'number', joint: 'a' },
			{ what: 'number', joint: 'a' },
			{ what: 'number', joint: 'a' }
		]);
	});

	test('of which there are 2000 are all read', () => {
		const states = Array.from({ length: 2000 }, (_, n) => state(`pose_${n}`, `group_${n % 2}`, joint('a', String(n / 1000))));
		const groups = groupsIn(robot(...states));
		expect(groups.map((group) => group.states.length)).toEqual([1000, 1000]);
		expect(numbersText(groups[1]?.states.at(-1)?.joints ?? [])).toBe('1.999');
	});

	test('are none where there are none, or what is there is no XML', () => {
		expect(readSrdf(robot())).toEqual({ what: 'none' });
		expect(readSrdf(robot('<group_state>'))).toEqual({ what: 'xml', line: 2 });
		expect(readSrdf('# joints: 1, 2')).toEqual({ what: 'xml', line: 1 });
	});
});

test.each([
	'<!DOCTYPE robot [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><robot>&b;</robot>',
	'<!doctype robot SYSTEM "file:///etc/passwd"><robot/>',
	'<robot><!ENTITY x SYSTEM "http://example.com/x"></robot>'
])('a text with entities of its own is not read at all: %s', (text) => {
	expect(readSrdf(text)).toEqual({ what: 'entities' });
});

test('nor is one without end', () => {
	expect(readSrdf(' '.repeat(5_000_001))).toEqual({ what: 'long' });
});
