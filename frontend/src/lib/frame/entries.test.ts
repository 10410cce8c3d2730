import { describe, expect, test } from 'vitest';
import { found, type Entry } from './entries.ts';

const entry = (group: Entry['group'], text: string, name = text): Entry => ({ group, text, name, does: { to: '/' } });
const ENTRIES = [
	entry('act', 'Pause', 'pause'),
	entry('page', 'State', 'state'),
	entry('operation', 'Why does “Place the bolts of pair 1” wait?', 'place_bolt_pair(pair_1)'),
	entry('ability', 'Move to the pose above the engine', 'robot.move_to(above)'),
	entry('variable', 'robot.pose'),
	entry('variable', 'operator.robot_is_near'),
	...Array.from({ length: 40 }, (_, index) => entry('variable', `kit.part_${String(index)}`))
];
const texts = (typed: string): string[] => found(ENTRIES, typed).flatMap(([, among]) => among.map(({ text }) => text));

describe('what the palette finds', () => {
	test('before anything is typed it is what can be done, and pages', () => {
		expect(texts(' ')).toEqual(['Pause', 'State']);
	});

	test('each word that is typed is in the text or the name, in any order', () => {
		expect(texts('engine robot')).toEqual(['Move to the pose above the engine']);
		expect(texts('WHY pair 1')).toEqual(['Why does “Place the bolts of pair 1” wait?']);
		expect(texts('engine nowhere')).toEqual([]);
	});

	test('what begins with it comes before what only has it', () => {
		const variables = found(ENTRIES, 'robot').find(([group]) => group === 'variable');
		expect(variables?.[1].map(({ text }) => text)).toEqual(['robot.pose', 'operator.robot_is_near']);
	});

	test('of many of a kind only some are offered, and the others when more is typed', () => {
		expect(texts('kit.part')).toHaveLength(8);
		expect(texts('kit.part_39')).toEqual(['kit.part_39']);
	});
});
