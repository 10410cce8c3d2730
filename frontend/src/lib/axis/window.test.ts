import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { SHORTEST, momentAt, moved, shareOf, showing, within, zoomed } from './window.ts';

const windows = fc
	.tuple(fc.integer({ min: 0, max: 100_000 }), fc.integer({ min: SHORTEST, max: 50_000 }))
	.map(([from, length]) => ({ from, to: from + length }));

test('a window stays upon the journal, whatever is asked of it', () => {
	fc.assert(
		fc.property(windows, fc.nat(100_000), fc.nat(100_000), (window, first, length) => {
			const { from, to } = within(window, first, first + length);
			expect(to - from).toBeGreaterThanOrEqual(SHORTEST - 1e-6);
			expect(from).toBeLessThanOrEqual(first + length);
			expect(to).toBeGreaterThanOrEqual(first);
			expect(to - from).toBeLessThanOrEqual(Math.max(length, SHORTEST) * 1.04 + 3);
		})
	);
});

describe('the line', () => {
	test('keeps a moment in its place while it is zoomed', () => {
		fc.assert(
			fc.property(windows, fc.double({ min: 0, max: 1, noNaN: true }), fc.double({ min: 1, max: 8, noNaN: true }), (window, share, factor) => {
				const at = momentAt(window, share);
				expect(shareOf(zoomed(window, factor, at), at)).toBeCloseTo(share, 6);
			})
		);
	});

	test('is moved and comes back', () => {
		const window = { from: 100, to: 200 };
		expect(moved(window, 0.5)).toEqual({ from: 150, to: 250 });
		expect(moved(moved(window, 0.5), -0.5)).toEqual(window);
	});

	test('is moved only as far as a moment needs it', () => {
		const window = { from: 100, to: 200 };
		expect(showing(window, 150)).toBe(window);
		expect(showing(window, 400)).toEqual({ from: 350, to: 450 });
	});
});
