import { expect, test } from 'vitest';
import { keyAt, keyOf, stepOf, unsaid, wrongIn } from './places.ts';
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

test('what the server says is told where it is written', () => {
	const problem = { place: ['devices', 1, 'name'], why: 'a name is missing', why_message: null };
	expect(wrongIn([problem], SKETCH)).toEqual([{ key: keyOf(robot.id, 'name'), step: 'devices', why: 'a name is missing' }]);
});

test('what is no number, and what was not chosen yet, is told without the server', () => {
	const sketch = sketchOf(BOLT);
	const words = { notNumbers: 'Write numbers.', notChosen: 'Choose one.' };
	expect(unsaid(sketch, words)).toEqual([]);
	sketch.devices[1]!.poses[1]!.joints = '0.6, up';
	sketch.product.steps[1]!.where[0]!.pose = null;
	sketch.never[0]!.facts[0]!.value = null;
	sketch.never[0]!.during[0]!.thing = null;
	expect(unsaid(sketch, words)).toEqual([
		{ key: keyOf(robot.poses[1]!.id, 'joints'), step: 'poses', why: 'Write numbers.' },
		{ key: keyOf(step.where[0]!.id, 'pose'), step: 'product', why: 'Choose one.' },
		{ key: keyOf(never.facts[0]!.id, 'value'), step: 'never', why: 'Choose one.' },
		{ key: keyOf(never.during[0]!.id, 'thing'), step: 'never', why: 'Choose one.' }
	]);
});
