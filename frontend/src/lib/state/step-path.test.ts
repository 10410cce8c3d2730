import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Stretch } from '#lib/stream/recorder.ts';
import { changesOf, stepPath } from './step-path.ts';

const SIZE = { width: 60, height: 10 };
const stretch = (at: number, last: number, low = last, high = last): Stretch => ({ at, low, high, last, changes: 1 });

test('a value steps to the next, and goes on until now', () => {
	expect(stepPath([stretch(900, 0), stretch(970, 2)], 3, 1000, SIZE)).toBe('M0 10H30V0H60');
	expect(stepPath([stretch(900, 0)], 1, 1000, SIZE)).toBe('M0 5H60');
	expect(stepPath([], 3, 1000, SIZE)).toBe('');
});

test('what was unknown is left out', () => {
	expect(stepPath([stretch(900, 1), stretch(960, NaN), stretch(980, 0)], 2, 1000, SIZE)).toBe('M0 0H20M40 10H60');
	expect(stepPath([stretch(900, NaN)], 2, 1000, SIZE)).toBe('');
});

test('several values within a second are a line upright', () => {
	expect(stepPath([stretch(900, 0), stretch(970, 1, 0, 2)], 3, 1000, SIZE)).toBe('M0 10H30V10V0V5H60');
});

test('a line never leaves its place', () => {
	const place = fc.oneof(fc.integer({ min: 0, max: 4 }), fc.constant(NaN));
	const tracks = fc.array(fc.tuple(fc.double({ min: 0, max: 2000, noNaN: true }), place));
	fc.assert(
		fc.property(tracks, (track) => {
			const path = stepPath(track.map(([at, value]) => stretch(at, value)), 5, 1000, SIZE);
			for (const [, command, x, y] of path.matchAll(/([MHV])([\d.-]+)(?: ([\d.-]+))?/g)) {
				const [across, up] = command === 'M' ? [Number(x), Number(y)] : command === 'H' ? [Number(x), 0] : [0, Number(x)];
				expect(across >= 0 && across <= 60 && up >= 0 && up <= 10).toBe(true);
			}
		})
	);
});

test('changes are counted for a minute', () => {
	expect(changesOf([stretch(900, 0), stretch(970, 1), stretch(980, 0)], 1000)).toBe(2);
});
