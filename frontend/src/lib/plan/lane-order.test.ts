import { expect, test } from 'vitest';
import type { StationView } from '#lib/contract.ts';
import { laneOrder } from './lane-order.ts';

const does = (resource: string, moves: boolean, human = false): StationView['abilities'][string] => ({
	resource,
	title: 'Do',
	human,
	restart: false,
	moves,
	enabled: null,
	executing: null,
	finished: null,
	running_since: null
});
const named = (...names: string[]): StationView['resources'] =>
	Object.fromEntries(names.map((name) => [name, { title: name } as StationView['resources'][string]]));

test('People come first, then what moves in the order of the model, and last what never moves', () => {
	const abilities = {
		'scene.attach': does('scene', false),
		'robot.attach': does('robot', false),
		'robot.move': does('robot', true),
		'operator.place': does('operator', true, true),
		'dock.lock': does('dock', true)
	};
	expect(laneOrder({ resources: named('scene', 'robot', 'light', 'dock', 'operator'), abilities })).toEqual([
		'operator',
		'robot',
		'dock',
		'scene'
	]);
});
