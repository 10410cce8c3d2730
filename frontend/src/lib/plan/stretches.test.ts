import { expect, test } from 'vitest';
import { operation, PLAN, step, task } from '#lib/testing/view.ts';
import { expectedOf, ROWS, roomOf, stretchesOf } from './stretches.ts';

const NOW = 1000;
const steps = [
	step('place', 'operator', 0, { id: '1', status: 'running', started: NOW - 4, expected_end: NOW + 2 }),
	step('tighten', 'nutrunner', 1, { id: '2', status: 'next', expected_start: NOW + 2, expected_end: NOW + 6 })
];

test('an operation reaches from where work for it begins to where its goal is reached', () => {
	const operations = {
		lay: operation({ title: 'Lay', began: NOW - 50, ended: NOW - 30 }),
		place: operation({ title: 'Place', active: true, active_since: NOW - 20, first_step: '1', last_step: '1' }),
		tighten: operation({ title: 'Tighten', active: true, active_since: NOW - 20, first_step: '2', last_step: '2' }),
		leave: operation({ title: 'Leave' }),
		out: operation({ title: 'Left out', active: true, active_since: NOW - 9 })
	};
	const found = stretchesOf(operations, steps, NOW, 60, 1);
	expect(found.map(({ operation, from, to, standing }) => [operation, from, to, standing])).toEqual([
		['lay', -50, -30, 'past'],
		['place', -4, 2, 'now'],
		['tighten', 2, 6, 'ahead']
	]);
});

test('names that have no room beside one another stand one below the other, as far as there are rows', () => {
	const began = (at: number): ReturnType<typeof operation> => operation({ began: NOW - at, ended: NOW - at + 1 });
	const operations = { a: began(30), b: began(29), c: began(28), d: began(10) };
	const found = stretchesOf(operations, [], NOW, 60, 5);
	expect(found.map(({ operation, row }) => [operation, row])).toEqual([
		['a', 0],
		['b', 1],
		['d', 0]
	]);
	expect(Math.max(...found.map(({ row }) => row))).toBeLessThan(ROWS);
	expect(found.map((_, index) => roomOf(found, index, 5))).toEqual([-10, 0, 0]);
});

test('what is worked on goes on where a newer plan has only the rest of it', () => {
	const rest = step('turn', 'nutrunner', 0, { id: '9', status: 'planned', expected_start: NOW + 3, expected_end: NOW + 8 });
	const work = [{ began: NOW - 5, ended: null }];
	const operations = { tighten: operation({ active: true, active_since: NOW - 20, first_step: '9', last_step: '9', work }) };
	const found = stretchesOf(operations, [rest], NOW, 60, 1);
	expect(found.map(({ from, to, standing }) => [from, to, standing])).toEqual([[-5, 8, 'now']]);
});

test('without a plan what is worked on goes on, and what is only active is not told', () => {
	const at = (work: readonly { began: number; ended: number | null }[]): ReturnType<typeof operation> =>
		operation({ active: true, active_since: NOW - 20, work: [...work] });
	const operations = { runs: at([{ began: NOW - 9, ended: NOW - 8 }, { began: NOW - 5, ended: null }]), rests: at([{ began: NOW - 9, ended: NOW - 8 }]), waits: at([]) };
	const found = stretchesOf(operations, [], NOW, 60, 1);
	expect(found.map(({ operation, from, to, standing }) => [operation, from, to, standing])).toEqual([['runs', -5, 0, 'now']]);
	expect(roomOf(found, 0, 1)).toBe(Infinity);
});

test('the name of what is over ends where the next of its row begins, and does not reach beyond the present', () => {
	const began = (at: number): ReturnType<typeof operation> => operation({ began: NOW - at, ended: NOW - at + 20 });
	const found = stretchesOf({ a: began(50), b: began(49), c: began(40) }, [], NOW, 60, 5);
	expect(found.map((_, index) => roomOf(found, index, 5))).toEqual([-40, 0, 0]);
});

test('what goes on has its place before what is over, of which nothing is said where it has left', () => {
	const over = (at: number): ReturnType<typeof operation> => operation({ began: NOW - at, ended: NOW - at + 1 });
	const runs = operation({ active: true, active_since: NOW - 20, work: [{ began: NOW - 10, ended: null }] });
	const found = stretchesOf({ a: over(12), b: over(11), runs }, [], NOW, 60, 5);
	expect(found.map(({ operation, row }) => [operation, row])).toEqual([
		['b', 1],
		['runs', 0]
	]);
	expect([roomOf(found, 0, 5, -20), roomOf(found, 0, 5, -8)]).toEqual([0, -6]);
});

test('what is too long ago is not told', () => {
	expect(stretchesOf({ old: operation({ began: NOW - 100, ended: NOW - 90 }) }, [], NOW, 60, 1)).toEqual([]);
});

test('what the list of operations shows as under way has begun on the plan, though its first step comes later', () => {
	const operations = { tighten: operation({ active: true, active_since: NOW - 2, first_step: '2', last_step: '2' }) };
	const at = (under: string[]): unknown[] => stretchesOf(operations, steps, NOW, 60, 1, new Set(under)).map(({ from, standing }) => [from, standing]);
	expect(at(['tighten'])).toEqual([[-2, 'now']]);
	expect(at([])).toEqual([[2, 'ahead']]);
});

test('what begins once a task is done is expected at the end of the task, for as long as another of its kind took', () => {
	const operations = {
		'tighten(p1)': operation({ title: 'Tighten pair 1', began: NOW - 30, ended: NOW - 25 }),
		'tighten(p2)': operation({ title: 'Tighten pair 2' })
	};
	const of = { operations, plan: { ...PLAN, steps }, tasks: { a: { ...task(NOW - 4), ability: 'place', begins: ['Tighten pair 2'] } } };
	expect(expectedOf(of, NOW)).toEqual([{ operation: 'tighten(p2)', title: 'Tighten pair 2', from: 2, to: 7, standing: 'expected' }]);
	expect(expectedOf({ ...of, tasks: {} }, NOW)).toEqual([]);
});
