import { expect, test } from 'vitest';
import type { WhatIf } from '#lib/contract.ts';
import { completionsOf, pairsOf } from './plans.ts';

type Run = WhatIf['runs'][number];
const run = (resource: string, ability: string, started: number, ended: number | null): Run => ({ resource, ability, title: ability, started, ended });

function plan(runs: Run[], completed: WhatIf['completed'] = []): WhatIf {
	return {
		seconds: 60,
		safe: true,
		runs,
		completed,
		before: {},
		after: {},
		active: [],
		unplanned: '',
		unplanned_message: null,
		obstacle: null,
		obstacle_message: null
	};
}

test('lanes in which something differs come first, that first in which it differs first', () => {
	const before = plan([run('same', 'a', 0, 2), run('late', 'b', 1, 9), run('soon', 'c', 1, 3)]);
	const after = plan([run('same', 'a', 0.1, 2.1), run('late', 'b', 1, 12), run('soon', 'c', 1, 5)]);
	expect(pairsOf(before, after).map(({ resource, differs }) => [resource, differs])).toEqual([
		['soon', true],
		['late', true],
		['same', false]
	]);
});

test('a lane that only one of them has differs, and what goes on lasts to the end', () => {
	const [pair] = pairsOf(plan([]), plan([run('new', 'a', 5, null)]));
	expect(pair).toMatchObject({ resource: 'new', before: [], differs: true });
	expect(pair?.after).toEqual([{ ability: 'a', title: 'a', from: 5, to: 60, open: true }]);
});

test('an operation is told that is done at another time, or with one of them only', () => {
	const done = (operation: string, at: number): WhatIf['completed'][number] => ({ operation, title: operation, at });
	const before = plan([], [done('one', 10), done('one', 20), done('two', 12), done('gone', 30)]);
	const after = plan([], [done('one', 15), done('two', 12.5), done('new', 40)]);
	expect(completionsOf(before, after)).toEqual([
		{ title: 'one', before: 10, after: 15 },
		{ title: 'gone', before: 30, after: null },
		{ title: 'new', before: null, after: 40 }
	]);
});
