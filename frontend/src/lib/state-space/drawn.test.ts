import { describe, expect, it } from 'vitest';
import type { FoldedState, StateArrow, StateCause } from '#lib/contract.ts';
import { drawnArrows, linesOf, lookOf, onPath, standingOf, valueLines } from './drawn.ts';

const node = (counts: Partial<FoldedState>): FoldedState => ({ values: [], states: 4, initial: false, present: false, violated: [], forbidden: 0, unsafe: 0, stuck: 0, cut: 0, ...counts });
const cause = (kind: string, allowed = true): StateCause => ({ kind, name: kind, title: { id: 'step.so', arguments: {} }, allowed, kept: !allowed });
const arrow = (source: number, sink: number, ...causes: StateCause[]): StateArrow => ({ source, sink, causes });

describe('how a node stands out', () => {
	it('is by the worst of what stands behind it, all or some of it', () => {
		expect(standingOf(node({}))).toEqual({ kind: 'safe', all: true });
		expect(standingOf(node({ unsafe: 4 }))).toEqual({ kind: 'unsafe', all: true });
		expect(standingOf(node({ unsafe: 4, forbidden: 1 }))).toEqual({ kind: 'forbidden', all: false });
	});
});

describe('the arrows that are drawn', () => {
	const view = { arrows: [arrow(0, 1, cause('start')), arrow(0, 2, cause('together')), arrow(1, 2, cause('device')), arrow(0, 3, cause('together'))], path: null };

	it('leave out several at once where something alone leads there', () => {
		expect(drawnArrows(view, false).map(({ sink }) => sink)).toEqual([1, 2, 3]);
		expect(drawnArrows(view, true)).toHaveLength(4);
	});

	it('have all that the plan goes through', () => {
		const path = [0, 0, 2].map((each) => ({ node: each, title: { id: 'step.so', arguments: {} } }));
		expect([...onPath(path)]).toEqual(['0 2']);
		expect(drawnArrows({ ...view, path }, false)).toHaveLength(4);
	});

	it('tell what the supervisor keeps back and what is a fault', () => {
		expect(lookOf(arrow(0, 1, cause('start', false)))).toBe('kept');
		expect(lookOf(arrow(0, 1, cause('start', false), cause('device')))).toBe('device');
		expect(lookOf(arrow(0, 1, cause('fault')))).toBe('fault');
		expect(lookOf(arrow(0, 1, cause('start'), cause('fault')))).toBe('start');
	});
});

describe('how a value is set in a node', () => {
	/** Letters are as wide as each other; strong ones are wider. */
	const measure = (text: string, isStrong = false): number => text.length * (isStrong ? 2 : 1);
	const room = { width: 20, gap: 2, most: 3 };

	it('has all of its words, in as many lines as they take', () => {
		expect(linesOf('home', 20, measure)).toBe(1);
		expect(linesOf('the pose before the tool', 12, measure)).toBe(3); // the pose | before the | tool
		expect(linesOf('unbrokenwordthatislong', 10, measure)).toBe(3);
		expect(linesOf('a unbrokenwordthatislong', 10, measure)).toBe(4);
	});

	it('is beside the name where each value has room there', () => {
		expect(valueLines('the pose', ['home', 'away'], room, measure)).toEqual({ below: false, name: 1, value: 1 });
	});

	it('is below it where one has none, and takes the lines of the longest', () => {
		const values = ['home', 'before the tool'];
		expect(valueLines('the pose', values, room, measure)).toEqual({ below: true, name: 1, value: 2 });
		expect(valueLines('the pose of the robot', values, room, measure)).toEqual({ below: true, name: 2, value: 2 });
	});

	it('is shortened where it would take too many', () => {
		expect(valueLines('it', ['a long value of very many words indeed'], room, measure).value).toBe(3);
	});
});
