import { describe, expect, test } from 'vitest';
import { move, removeDevice, removeState } from './arranging.ts';
import { blank, isWritten, outlineOf, readSketch, sketchOf } from './sketch.ts';
import { BOLT, DOOR } from './testing.ts';

describe('an outline that is gone on with', () => {
	test.each([BOLT, DOOR])('is the same again: $title', (outline) => {
		expect(outlineOf(sketchOf(outline))).toEqual(outline);
	});

	test('says the same of a part when that is called otherwise', () => {
		const sketch = sketchOf(BOLT);
		sketch.devices[1]!.name = 'arm';
		sketch.devices[1]!.poses[2]!.name = 'down';
		sketch.product.steps[0]!.name = 'put_it_there';
		const { product, never } = outlineOf(sketch);
		expect(product.steps[1]!.where).toEqual([{ robot: 'arm', pose: 'down' }]);
		expect(never[0]!.facts).toEqual([{ thing: 'arm', value: 'down', holds: true }]);
		expect(never[0]!.during).toEqual([{ thing: 'step:operator.put_it_there', value: 'under_way', holds: false }]);
	});

	test('keeps two of one name apart', () => {
		const sketch = sketchOf(DOOR);
		const [robot, other] = sketch.devices.filter(({ kind }) => kind === 'robot');
		other!.name = robot!.name;
		other!.name = 'again';
		expect(outlineOf(sketch).never[0]!.facts.map(({ thing }) => thing)).toEqual(['left', 'again']);
	});

	test('has nothing in the place of what was taken away, so that it is told', () => {
		const sketch = sketchOf(BOLT);
		removeDevice(sketch, sketch.devices[1]!.id);
		const { product, never } = outlineOf(sketch);
		expect(product.steps[1]!.where).toEqual([{ robot: '', pose: '' }]);
		expect(never[0]!.facts).toEqual([{ thing: '', value: '', holds: true }]);
	});
});

test('a state goes with the step that leads to it, and the first one with that which leads on', () => {
	const names = ({ product }: ReturnType<typeof sketchOf>): string[][] => [product.states.map(({ name }) => name), product.steps.map(({ name }) => name)];
	const one = sketchOf(BOLT);
	removeState(one, one.product.states[2]!.id);
	expect(names(one)).toEqual([['missing', 'placed'], ['place_it']]);
	const other = sketchOf(BOLT);
	removeState(other, other.product.states[0]!.id);
	expect(names(other)).toEqual([['placed', 'tight'], ['tighten']]);
	removeState(other, other.product.states[0]!.id);
	expect(names(other)).toEqual([['tight'], []]);
});

test('what is moved over an end stays', () => {
	const parts = [1, 2, 3];
	move(parts, 0, -1);
	move(parts, 2, 1);
	expect(parts).toEqual([1, 2, 3]);
	move(parts, 0, 1);
	expect(parts).toEqual([2, 1, 3]);
});

describe('what is kept', () => {
	test('is read again as it was', () => {
		const sketch = sketchOf(BOLT, 'bolt');
		expect(readSketch(JSON.stringify(sketch))).toEqual(sketch);
	});

	test.each([null, '', 'null', '{}', '[]', '"text"', '{"last": 3, "title": "x", "product": {"states": []}}', '{"last": 3, "title": "x", "devices": 5, "product": {"states": [], "steps": []}, "never": []}'])(
		'is not taken for a sketch: %s',
		(text) => {
			expect(readSketch(text)).toBeNull();
		}
	);
});

test('a template is nothing that was written, until it is changed', () => {
	const templates = { bolt: BOLT };
	expect(isWritten(blank(), templates)).toBe(false);
	expect(isWritten({ ...blank(), title: 'My station' }, templates)).toBe(false);
	const sketch = sketchOf(BOLT, 'bolt');
	expect(isWritten(sketch, templates)).toBe(false);
	sketch.devices[0]!.title = 'Worker';
	expect(isWritten(sketch, templates)).toBe(true);
});
