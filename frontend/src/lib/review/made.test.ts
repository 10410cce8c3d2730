import { expect, test } from 'vitest';
import type { FileMark } from '#lib/contract.ts';
import { madeIn } from './made.ts';

const marks = (states: Readonly<Record<string, FileMark['state']>>): Record<string, FileMark> =>
	Object.fromEntries(Object.entries(states).map(([path, state]) => [path, { digest: path, state }]));

test('what a first station is made of is told apart', () => {
	const files = marks({
		'station.yaml': 'changed', 'resources/robot.yaml': 'new', 'resources/operator.yaml': 'new', 'operations.yaml': 'new',
		'specifications.yaml': 'new', 'messages/a_msgs/msg/RobotState.msg': 'new', 'tests/first.yaml': 'new', 'planning.yaml': 'new'
	});
	expect(madeIn(files)).toEqual({ devices: 2, operations: true, never: true, order: false, tests: 1, messages: 1, others: 1 });
});

test('where the station has devices its changes are counted', () => {
	expect(madeIn(marks({ 'resources/robot.yaml': 'changed', 'resources/door.yaml': 'new' }))).toBeNull();
	expect(madeIn(marks({ 'resources/robot.yaml': 'removed', 'resources/door.yaml': 'new' }))).toBeNull();
	expect(madeIn(marks({ 'station.yaml': 'changed', 'operations.yaml': 'new' }))).toBeNull();
});
