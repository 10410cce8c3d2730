import { expect, test } from 'vitest';
import { operate } from '#lib/text/en/operate.ts';
import { PLAN, step } from '#lib/testing/view.ts';
import { beginText, leftOf, lengthText, promiseText } from './expected.ts';

const NOW = 1000;
const done = step('a', 'robot', 0, { status: 'done', started: 980, ended: 988 });
const runs = step('b', 'robot', 0, { status: 'running', started: 995, expected_end: 1003 });
const next = step('c', 'robot', 0, { status: 'next', expected_start: 996, expected_end: 999.4 });
const then = step('d', 'robot', 1, { expected_start: 1001, expected_end: 1006 });
const late = 4;

test('what has begun says when and for how long, the rest what is expected, later where it is late', () => {
	const all = [done, runs, next, then];
	expect(all.map((each) => beginText(each, NOW, late, true, operate.plan))).toEqual(['20 s ago', '5 s ago', 'now', 'in 5 s']);
	expect(all.map((each) => lengthText(each, NOW, late, operate.plan))).toEqual(['0:08', '0:05, about 8 s', 'about 3 s', 'about 5 s']);
	expect(leftOf(all, NOW)).toBe(10);
	expect(leftOf([done], NOW)).toBeNull();
});

test('a plan says how much of it is ahead, when less might do, and who found it', () => {
	const plan = { ...PLAN, steps: [done, { ...next, expected_start: NOW, expected_end: NOW + 3 }], ticks: 1 };
	expect(promiseText(plan, NOW, operate.plan)).toBe(
		'The shortest plan there is, proven: 1 start to come. Done in about 3 s.'
	);
	const soon = { ...plan, ticks: 6, contract: 'fast' as const, minimal_ticks: false, milliseconds: 12.3, engine: 'search' };
	expect(promiseText(soon, NOW, operate.plan)).toBe(
		'Found soon: 1 start to come. There may be a shorter plan. Done in about 3 s. Found in 12 ms by search.'
	);
	expect(promiseText({ ...PLAN, contract: null, milliseconds: 0.41 }, NOW, operate.plan)).toBe('Found in 0.4 ms.');
});
