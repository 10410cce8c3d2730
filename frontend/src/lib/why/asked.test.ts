import { expect, test } from 'vitest';
import type { Condition, ReasonTree } from '#lib/contract.ts';
import { operationOf, untold } from './asked.ts';

const condition = (kind: string): Condition => ({
	kind,
	text: kind,
	text_message: { id: 'waits.step', arguments: {} },
	expanded: null,
	involved: [],
	sentence: null
});
const tree = (about: ReasonTree['about'], holds: boolean | null, wanted = true): ReasonTree => ({
	about,
	specifications: [],
	rest: false,
	sequence: null,
	tree: {
		kind: 'leaf',
		text: 'a',
		sentence: { id: 'sentence.so', arguments: { condition: 'a' } },
		predicate: null,
		holds,
		wanted,
		decides: true,
		reads: [],
		involved: [],
		parts: []
	}
});
const kinds = (conditions: string[], trees: ReasonTree[]): string[] =>
	untold({ conditions: conditions.map(condition), trees }).map(({ kind }) => kind);

test('what a tree tells is not told beside it', () => {
	expect(kinds(['station', 'written', 'supervisor'], [tree('enabled', false)])).toEqual(['station', 'supervisor']);
	expect(kinds(['written', 'supervisor'], [tree('enabled', true), tree('supervisor', null)])).toEqual(['written']);
	expect(kinds(['written'], [tree('undone', true, false)])).toEqual([]);
});

test('what no tree explains is told', () => {
	expect(kinds(['written', 'plan'], [tree('enabled', true)])).toEqual(['written', 'plan']);
	expect(kinds(['supervisor'], [])).toEqual(['supervisor']);
});

test('the activity of an operation leads to it', () => {
	expect(operationOf('operation.tighten(bolt_pair_1).active')).toBe('tighten(bolt_pair_1)');
	expect(operationOf('robot.pose')).toBeNull();
});
