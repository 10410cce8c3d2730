import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Trace, TraceStep } from '#lib/contract.ts';
import { acting, actingAt, forbiddenAt, moving, namesIn, rowsAt, stepTo } from './play.ts';

function step(changes: TraceStep['changes'], forbidden: string[] = []): TraceStep {
	return { kind: 'tick', names: [], finished: [], changes, forbidden_by: forbidden, text: '' };
}

const TRACE: Trace = {
	initial: { pose: 'home', hot: false, level: null },
	forbidden_by: [],
	steps: [step({ hot: true }), step({}), step({ hot: false, level: 2 }, ['never_full'])]
};

test('the initial state comes first, and nothing has changed in it', () => {
	expect(stepTo(TRACE, 0)).toBeNull();
	expect(rowsAt(TRACE, 0)).toEqual([
		{ name: 'hot', value: false, before: false, changed: false },
		{ name: 'level', value: null, before: null, changed: false },
		{ name: 'pose', value: 'home', before: 'home', changed: false }
	]);
});

test('after a step what it changes is marked, with what that was before', () => {
	expect(rowsAt(TRACE, 3)).toEqual([
		{ name: 'hot', value: false, before: true, changed: true },
		{ name: 'level', value: 2, before: null, changed: true },
		{ name: 'pose', value: 'home', before: 'home', changed: false }
	]);
	expect(rowsAt(TRACE, 2).filter(({ changed }) => changed)).toEqual([]);
});

test('the specifications that forbid a state are those of its step, or of the beginning', () => {
	expect([0, 1, 2, 3].map((place) => forbiddenAt(TRACE, place))).toEqual([[], [], [], ['never_full']]);
	expect(forbiddenAt({ ...TRACE, forbidden_by: ['never_cold'] }, 0)).toEqual(['never_cold']);
});

test('some variables move on the way', () => {
	expect(moving(TRACE)).toEqual(new Set(['hot', 'level']));
});

test('effects are named without arguments, and nothing else is', () => {
	expect(namesIn({ kind: 'tick', names: ['robot.move(home).leaves', 'tool.starts'] })).toBe('robot.move.leaves, tool.starts');
	expect(namesIn({ kind: 'start', names: ['robot.move(home)'] })).toBe('robot.move(home)');
});

describe('any run', () => {
	const changes = fc.dictionary(fc.constantFrom('a', 'b', 'c'), fc.boolean());
	const trace = fc.record({
		initial: fc.constant({ a: false, b: false, c: false }),
		forbidden_by: fc.constant<string[]>([]),
		steps: fc.array(changes.map((each) => step(each)))
	});

	test('is before each step as it was after the one before', () => {
		fc.assert(
			fc.property(trace, (played) => {
				for (let place = 1; place <= played.steps.length; place++)
					expect(rowsAt(played, place).map((row) => row.before)).toEqual(
						rowsAt(played, place - 1).map((row) => row.value)
					);
			})
		);
	});
});

test('the ability that acts is the one of the step, or the last before it', () => {
	const start = (name: string): TraceStep => ({ ...step({}), kind: 'start', names: [name] });
	const run = { ...TRACE, steps: [step({}), start('lift'), { ...step({}), finished: ['lift'] }, start('drop'), step({})] };
	expect(acting(run)).toEqual(['lift', 'drop']);
	expect([0, 1, 2, 3, 4, 5].map((place) => actingAt(run, place))).toEqual(['lift', 'lift', 'lift', 'lift', 'drop', 'drop']);
	expect(acting(TRACE)).toEqual([]);
	expect(actingAt(TRACE, 2)).toBeNull();
});
