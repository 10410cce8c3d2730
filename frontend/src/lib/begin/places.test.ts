import { describe, expect, test } from 'vitest';
import { keyAt, keyOf, stepOf, wrongIn } from './places.ts';
import { sketchOf } from './sketch.ts';
import { BOLT } from './testing.ts';

const SKETCH = sketchOf(BOLT);
const robot = SKETCH.devices[1]!;
const step = SKETCH.product.steps[1]!;
const never = SKETCH.never[0]!;

test.each([
	[['title'], keyOf(null, 'title'), 'station'],
	[['devices'], keyOf(null, 'devices'), 'devices'],
	[['devices', 1, 'name'], keyOf(robot.id, 'name'), 'devices'],
	[['devices', 1, 'poses'], keyOf(robot.id, 'poses'), 'poses'],
	[['devices', 1, 'poses', 2, 'joints'], keyOf(robot.poses[2]!.id, 'joints'), 'poses'],
	[['product', 'name'], keyOf(SKETCH.product.id, 'name'), 'product'],
	[['product', 'states'], keyOf(SKETCH.product.id, 'states'), 'product'],
	[['product', 'states', 0, 'name'], keyOf(SKETCH.product.states[0]!.id, 'name'), 'product'],
	[['product', 'steps', 1, 'where', 0, 'pose'], keyOf(step.where[0]!.id, 'pose'), 'product'],
	[['never', 0, 'facts'], keyOf(never.id, 'facts'), 'never'],
	[['never', 0, 'during', 0, 'thing'], keyOf(never.during[0]!.id, 'thing'), 'never'],
	[['devices', 99, 'name'], keyOf(null, 'devices.99.name'), 'devices'],
	[['elsewhere'], keyOf(null, 'elsewhere'), 'station']
])('what is wrong at %j is said where that is written', (place, key, of) => {
	expect(keyAt(place, SKETCH)).toBe(key);
	expect(stepOf(place)).toBe(of);
});

describe('all that is wrong', () => {
	const words = { notNumbers: 'Write numbers.' };
	const problem = (place: (string | number)[], why: string) => ({ place, why, why_message: null });

	test('is said as the server says it', () => {
		expect(wrongIn([problem(['devices', 1, 'name'], 'a name is missing')], SKETCH, words)).toEqual([
			{ key: keyOf(robot.id, 'name'), step: 'devices', why: 'a name is missing' }
		]);
	});

	test('has what cannot be sent, in the place of what follows from that', () => {
		const sketch = sketchOf(BOLT);
		sketch.devices[1]!.poses[1]!.joints = '0.6, up';
		const found = wrongIn([problem(['devices', 1, 'poses', 1, 'joints'], 'there are no joints')], sketch, words);
		expect(found.map(({ why }) => why)).toEqual(['Write numbers.']);
	});
});
