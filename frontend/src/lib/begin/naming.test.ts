import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { badName } from '#lib/model/names.ts';
import { freeName, nameOf, others, retitle } from './naming.ts';

describe('a name that follows from a title', () => {
	test.each([
		['Robot', 'robot'],
		['Robot 2, left', 'robot_2_left'],
		['Läge över bulten', 'lage_over_bulten'],
		['Ærø & Straße', 'aero_strasse'],
		['2nd clamp', '_2nd_clamp'],
		['  at the bolt  ', 'at_the_bolt'],
		['螺栓', ''],
		['', '']
	])('%j gives %j', (title, name) => {
		expect(nameOf(title)).toBe(name);
	});

	test('is one that the model can have, or none, whatever the title; words of the language are told by the server', () => {
		fc.assert(
			fc.property(fc.string({ unit: 'binary' }), (title) => {
				expect([null, 'empty', 'word']).toContain(badName('enumeration', nameOf(title), []));
			})
		);
	});

	test('gets a number where it is taken', () => {
		expect(freeName('robot', [])).toBe('robot');
		expect(freeName('robot', ['robot', 'robot_2'])).toBe('robot_3');
		expect(freeName('', [''])).toBe('');
	});
});

describe('another title', () => {
	const part = (title: string, name: string) => ({ id: 1, title, name });

	test('brings its name along, until somebody writes one', () => {
		const robot = part('', '');
		for (const title of ['R', 'Ro', 'Robot']) retitle(robot, title, []);
		expect(robot.name).toBe('robot');
		robot.name = 'arm';
		retitle(robot, 'Robot of the cell', []);
		expect(robot).toEqual({ id: 1, title: 'Robot of the cell', name: 'arm' });
	});

	test('never gives two the same name on the way', () => {
		const second = part('', '');
		for (const title of ['Robo', 'Robot', 'Robot ', 'Robot 2']) {
			retitle(second, title, ['robot']);
			expect(second.name).not.toBe('robot');
		}
		expect(second.name).toBe('robot_2');
	});

	test('that has no letters leaves no name, and a name comes back with the next', () => {
		const robot = part('Robot', 'robot');
		retitle(robot, '', []);
		expect(robot.name).toBe('');
		retitle(robot, 'Arm', []);
		expect(robot.name).toBe('arm');
	});
});

test('the names of the others are those of all but one', () => {
	const parts = [1, 2, 3].map((id) => ({ id, title: '', name: `pose_${id}` }));
	expect(others(parts, parts[1]!)).toEqual(['pose_1', 'pose_3']);
});
