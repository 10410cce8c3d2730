import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Topic } from '#lib/contract.ts';
import { OVER, noted, rateOf, rateText, type Note } from './traffic.ts';

const counted = (messages: number): Record<string, Topic> => ({
	'/t': {
		type: 'p/msg/T',
		direction: 'in',
		resource: 'r',
		last: null,
		messages,
		deadline: null,
		fresh: true,
		peers: 1,
		trouble: null, trouble_message: null
	}
});

/** What is noted where the counter is at `counts[n]` in second `n`. */
const after = (counts: readonly number[]): Note[] =>
	counts.reduce<Note[]>((notes, count, second) => noted(notes, second, counted(count)), []);

test('a topic that speaks evenly has its rate, however long it is looked at', () => {
	fc.assert(
		fc.property(fc.nat(200), fc.integer({ min: 2, max: 30 }), (perSecond, seconds) => {
			const notes = after(Array.from({ length: seconds }, (_, second) => second * perSecond));
			expect(rateOf(notes, '/t')).toBeCloseTo(perSecond);
			expect(notes.length).toBeLessThanOrEqual(OVER + 1);
		})
	);
});

test('one that falls silent has the rate of the last seconds, and then none', () => {
	const speaking = [0, 10, 20, 30, 40, 50];
	expect(rateOf(after([...speaking, 50, 50]), '/t')).toBeCloseTo(6);
	expect(rateOf(after([...speaking, 50, 50, 50, 50, 50]), '/t')).toBe(0);
});

test('nothing is said of a topic that was seen once, or whose controller has just been started anew', () => {
	expect(rateOf(after([7]), '/t')).toBeNull();
	expect(rateOf(after([100, 200, 3]), '/t')).toBeNull();
	expect(rateOf(after([100, 200, 3, 13]), '/t')).toBe(10);
	expect(rateOf(after([1, 2]), '/other')).toBeNull();
});

test('a rate keeps two figures or so', () => {
	expect([0, 0.25, 9.84, 119.6].map((rate) => rateText(rate, 'en-GB'))).toEqual(['0', '0.25', '9.8', '120']);
});
