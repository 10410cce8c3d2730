import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { StreamMessage, Value, Variable } from '#lib/contract.ts';
import { estimate, view } from '#lib/testing/view.ts';
import { Recorder, WINDOW } from './recorder.ts';

const DOMAIN = ['empty', 'placed', 'tightened'];

const made = (value: Value | null, since: number): Variable => estimate({ domain: DOMAIN, value, since });
const snapshot = (time: number, variables: Record<string, Variable>): StreamMessage => ({
	kind: 'snapshot',
	sequence: 1,
	age: null,
	view: view({ time, variables })
});
const delta = (time: number, variables: Record<string, Variable>, gone: string[] = []): StreamMessage => ({
	kind: 'delta',
	sequence: 1,
	changed: { time, variables },
	removed: { variables: gone }
});

/** Changes of one variable, each some time after the one before. */
const changes = fc.array(
	fc.record({ after: fc.double({ min: 0.05, max: 1.9, noNaN: true }), place: fc.integer({ min: -1, max: 2 }) }),
	{ maxLength: 400 }
);

describe('what was heard of a variable', () => {
	test('ends with what it is, in the order of time, within bounds, and takes no more than a minute can', () => {
		fc.assert(
			fc.property(changes, (all) => {
				const recorder = new Recorder();
				recorder.hear(snapshot(1000, { b: made('empty', 400) }));
				let time = 1000;
				let place = 0;
				for (const change of all) {
					time += change.after;
					place = change.place;
					recorder.hear(delta(time, { b: made(DOMAIN[place] ?? null, time) }));
				}
				const track = recorder.of('b');
				expect(track.at(-1)?.last).toBe(place < 0 ? NaN : place);
				expect(track.length).toBeLessThanOrEqual(WINDOW + 3);
				for (const [index, { at, low, high, last }] of track.entries()) {
					expect(at).toBeGreaterThanOrEqual(track[index - 1]?.at ?? 0);
					if (!Number.isNaN(last)) expect([low <= last, last <= high]).toEqual([true, true]);
				}
			})
		);
	});

	test('begins where it got the value that it has', () => {
		const recorder = new Recorder();
		recorder.hear(snapshot(1000, { b: made('placed', 950) }));
		expect(recorder.of('b')).toEqual([{ at: 950, low: 1, high: 1, last: 1, changes: 0 }]);
	});

	test('goes on over a snapshot, unless it is not known what was before', () => {
		const recorder = new Recorder();
		recorder.hear(snapshot(1000, { b: made('empty', 950) }));
		recorder.hear(snapshot(1001.5, { b: made('placed', 1001) }));
		expect(recorder.of('b')).toHaveLength(2);
		recorder.hear(snapshot(1010, { b: made('placed', 1001) }));
		expect(recorder.of('b')).toHaveLength(1);
	});

	test('goes back to what was before, as it is told', () => {
		const recorder = new Recorder();
		const b = made('placed', 990);
		recorder.hear(snapshot(1000, { b }));
		const empty = { at: 940, value: 'empty' };
		recorder.recall(new Map([['b', [empty, { at: 970, value: null }, { at: 990, value: 'placed' }]], ['gone', [empty]]]), { b });
		expect(recorder.of('b')).toEqual([
			{ at: 940, low: 0, high: 0, last: 0, changes: 0 },
			{ at: 970, low: NaN, high: NaN, last: NaN, changes: 1 },
			{ at: 990, low: 1, high: 1, last: 1, changes: 1 }
		]);
		expect(recorder.of('gone')).toEqual([]);
		// Told once more, nothing is there twice.
		recorder.recall(new Map([['b', [empty]]]), { b });
		expect(recorder.of('b')).toHaveLength(3);
	});

	test('is several values where it changed several times within a second', () => {
		const recorder = new Recorder();
		recorder.hear(snapshot(1000, { b: made('empty', 950) }));
		for (const [index, value] of ['tightened', null, 'placed'].entries())
			recorder.hear(delta(1000.1 + index / 10, { b: made(value, 1000.1 + index / 10) }));
		expect(recorder.of('b').at(-1)).toEqual({ at: 1000.1, low: 1, high: 2, last: 1, changes: 3 });
	});
});

test('places of integers count from the first of their range', () => {
	const recorder = new Recorder();
	recorder.hear(snapshot(1000, { n: estimate({ domain: [5, 6, 7], value: 7, since: 990 }) }));
	expect(recorder.of('n').at(-1)?.last).toBe(2);
});

test('other variables than before are noticed', () => {
	const recorder = new Recorder();
	expect(recorder.hear(snapshot(1000, { b: made('empty', 950) }))).toBe(true);
	expect(recorder.hear(delta(1001, { b: made('placed', 1001) }))).toBe(false);
	expect(recorder.hear(delta(1002, { c: made('placed', 1002) }))).toBe(true);
	expect(recorder.hear(delta(1003, {}, ['b']))).toBe(true);
	expect(recorder.of('b')).toEqual([]);
});
