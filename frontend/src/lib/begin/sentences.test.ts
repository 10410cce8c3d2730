import { expect, test } from 'vitest';
import { sv } from '#lib/text/sv.ts';
import { say } from '#lib/text/text.svelte.ts';
import { neverText, sentences } from './sentences.ts';
import { blank, sketchOf } from './sketch.ts';
import { BOLT, DOOR } from './testing.ts';
import { thingsOf } from './things.ts';

const told = (of: typeof BOLT): string[] => sentences(sketchOf(of), say()).map(({ text }) => text);

test('what was said is read as sentences, in the order of the steps', () => {
	expect(told(BOLT)).toEqual([
		'The station is called “Bolt”.',
		'Operator is asked for tasks on a watch.',
		'Robot goes to named poses.',
		'Nutrunner runs until it is done.',
		'Lamp is on the network, with 1 topic.',
		'Robot goes along a row: home, above the bolt and at the bolt.',
		'At first bolt is missing.',
		'Place the bolt: Operator brings it from missing to placed.',
		'Tighten the bolt: Nutrunner brings it from placed to tight. Meanwhile Robot is in the pose “at the bolt”.',
		'When bolt is done the next one comes by itself.',
		'Never Robot in the pose “at the bolt” while Place the bolt is not under way.'
	]);
});

test('what has no title is called by its name', () => {
	expect(told(DOOR)).toContain('At first part is raw.');
	expect(told(DOOR)).toContain('Never Left robot in the pose “at the table” and Right robot in the pose “At the table”.');
	expect(told(DOOR)).toContain('When part is done the next one comes with an order. For that press By order on Orders.');
});

test('of nothing nothing is said', () => {
	expect(sentences(blank(), say())).toEqual([]);
});

test('what was not chosen yet, or is there no more, leaves a gap', () => {
	const sketch = sketchOf(BOLT);
	const things = thingsOf(sketch, say().begin.values);
	const gap = { facts: [{ id: 99, thing: null, value: null, holds: false }], during: [{ id: 98, thing: sketch.devices[0]!.id, value: null, holds: true }] };
	expect(neverText(gap, things, say())).toBe('Never … while Operator is …');
});

test('it is said in Swedish, too', () => {
	const texts = sentences(sketchOf(BOLT), sv).map(({ text }) => text);
	expect(texts).toContain('Robot går längs en rad: home, above the bolt och at the bolt.');
	expect(texts).toContain('Aldrig Robot i läget ”at the bolt” medan Place the bolt inte är på gång.');
});
