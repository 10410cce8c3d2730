import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { distanceText, stepOf, ticksOf } from './ticks.ts';

const span = fc.record({
	from: fc.double({ min: -1e6, max: 1e6, noNaN: true }),
	length: fc.double({ min: 0.001, max: 1e6, noNaN: true }),
	most: fc.integer({ min: 1, max: 20 }),
	origin: fc.double({ min: -1e6, max: 1e6, noNaN: true })
});

describe('the marks of an axis', () => {
	test('lie on it, ascend by one step, and are few', () => {
		fc.assert(
			fc.property(span, ({ from, length, most, origin }) => {
				const ticks = ticksOf(from, from + length, most, origin);
				const step = stepOf(length, most);
				expect(ticks.length).toBeLessThanOrEqual(most + 1);
				for (const [index, tick] of ticks.entries()) {
					expect(tick).toBeGreaterThanOrEqual(from - 1e-6);
					expect(tick).toBeLessThanOrEqual(from + length + 1e-6);
					if (index > 0) expect(tick - (ticks[index - 1] ?? 0)).toBeCloseTo(step, 6);
				}
			})
		);
	});

	test('are none where there is no axis', () => {
		expect(ticksOf(1, 1, 5)).toEqual([]);
		expect(ticksOf(2, 1, 5)).toEqual([]);
	});

	test('are counted from their origin', () => {
		expect(ticksOf(-12, 12, 5, 0)).toEqual([-10, -5, 0, 5, 10]);
		expect(ticksOf(0, 25, 5, 3)).toEqual([3, 8, 13, 18, 23]);
	});
});

test.each([
	[0, ''],
	[-20, '−20 s'],
	[60, '+1 min'],
	[90, '+1:30 min'],
	[-7200, '−2 h'],
	[5400, '+1:30 h']
])('%d seconds from the present say %j', (seconds, text) => {
	expect(distanceText(seconds)).toBe(text);
});
