import { describe, expect, test } from 'vitest';
import { say } from '#lib/text/text.svelte.ts';
import { neverText } from './sentences.ts';
import { blank, sketchOf, type Sketch } from './sketch.ts';
import { suggestionsOf } from './suggestions.ts';
import { BOLT, DOOR } from './testing.ts';
import { thingsOf } from './things.ts';

function told(sketch: Sketch): string[] {
	const things = thingsOf(sketch, say().begin.values);
	const numbered = (facts: ReturnType<typeof suggestionsOf>[number]['facts']) => facts.map((fact) => ({ ...fact, id: 0 }));
	return suggestionsOf(sketch).map(({ facts, during }) => neverText({ facts: numbered(facts), during: numbered(during) }, things, say()));
}

describe('what probably must never be', () => {
	test('a robot at work where a person is', () => {
		expect(told(sketchOf(BOLT))).toEqual(['Never Robot in the pose “at the bolt” while Operator is busy']);
	});

	test('but not where the person is asked to work beside it', () => {
		const sketch = sketchOf(BOLT);
		sketch.product.steps[0]!.where = [{ ...sketch.product.steps[1]!.where[0]!, id: 900 }];
		expect(told(sketch)).toEqual([]);
	});

	test('a robot at work behind an open door, two robots at one place, and a tool at what is not held', () => {
		const sketch = { ...sketchOf(DOOR), never: [] };
		expect(told(sketch)).toEqual([
			'Never Left robot in the pose “at the table” while Door is open',
			'Never Left robot in the pose “at the table” and Right robot in the pose “At the table”',
			'Never Press running while Gripper is open'
		]);
	});

	test('is not suggested where it was said, in whatever order', () => {
		const sketch = sketchOf(DOOR);
		sketch.never[0]!.facts.reverse();
		expect(told(sketch)).not.toContain('Never Left robot in the pose “at the table” and Right robot in the pose “At the table”');
		expect(told(sketch)).toHaveLength(2);
	});

	test('is not suggested where something else was said of the same things', () => {
		const sketch = sketchOf(BOLT);
		sketch.never[0]!.during = [{ id: 900, thing: sketch.devices[0]!.id, value: 'free', holds: false }];
		expect(told(sketch)).toEqual([]);
	});

	test('are three at most, and none of nothing', () => {
		const sketch = sketchOf({ ...BOLT, devices: [...BOLT.devices, ...['b', 'c', 'd', 'e'].map((name) => ({ kind: 'person' as const, name, title: name }))] });
		expect(told(sketch)).toHaveLength(3);
		expect(told(blank())).toEqual([]);
	});
});
