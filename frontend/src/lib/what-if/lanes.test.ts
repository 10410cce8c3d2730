import { expect, test } from 'vitest';
import type { WhatIf } from '#lib/contract.ts';
import { changesOf, lanesOf } from './lanes.ts';

const FOUND: WhatIf = {
	seconds: 20,
	safe: true,
	runs: [
		{ ability: 'robot.move', title: 'Move', resource: 'robot', started: 1, ended: 4 },
		{ ability: 'tool.run', title: 'Run', resource: 'tool', started: 2, ended: null },
		{ ability: 'robot.home', title: 'Go home', resource: 'robot', started: 5, ended: 5 }
	],
	completed: [{ operation: 'drill', title: 'Drill', at: 6 }],
	before: { a: 1, b: null, c: true },
	after: { a: 2, b: null, c: true, d: 'new' },
	active: [],
	unplanned: '',
	obstacle: null
};

test('each resource that does something has a lane, and what goes on lasts until the end', () => {
	const lanes = lanesOf(FOUND, (name) => name.toUpperCase(), 'Operations');
	expect(lanes.map((lane) => [lane.title, lane.bars.map(({ from, to, open }) => [from, to, open])])).toEqual([
		['ROBOT', [[1, 4, false], [5, 5, false]]],
		['TOOL', [[2, 20, true]]],
		['Operations', []]
	]);
	expect(lanes[2]?.spots.map(({ time, label }) => [time, label])).toEqual([[6, 'Drill']]);
});

test('without completed operations there is no lane for them', () => {
	expect(lanesOf({ ...FOUND, completed: [] }, String, 'Operations').map((lane) => lane.id)).toEqual(['robot', 'tool']);
});

test('what is otherwise in the end', () => {
	expect(changesOf(FOUND)).toEqual([
		{ name: 'a', before: 1, after: 2 },
		{ name: 'd', before: undefined, after: 'new' }
	]);
});
