/** Texts of drawings keep to the room that they have. */
import fc from 'fast-check';
import { expect, it } from 'vitest';
import { folded } from './measure.svelte.ts';

const letters = (text: string): number => text.length;

it('is folded between words, and what the last line has no room for is left out', () => {
	expect(folded('The pose above the oil filter', 16, 'small', 2, letters)).toEqual(['The pose above', 'the oil filter']);
	expect(folded('Home', 16, 'small', 2, letters)).toEqual(['Home']);
	expect(folded('The pose before the frame tool', 12, 'small', 2, letters)).toEqual(['The pose', 'before the…']);
	expect(folded('The pose above', 9, 'small', 1, letters)).toEqual(['The pose…']);
});

it('is never wider or longer than asked for, and keeps all where there is room', () => {
	const words = fc.array(fc.stringMatching(/^[a-z]{1,12}$/), { minLength: 1, maxLength: 9 });
	fc.assert(
		fc.property(words, fc.integer({ min: 1, max: 40 }), fc.integer({ min: 1, max: 4 }), (given, room, most) => {
			const lines = folded(given.join(' '), room, 'small', most, letters);
			expect(lines.length).toBeLessThanOrEqual(most);
			for (const line of lines) expect(line.length).toBeLessThanOrEqual(room);
			if (!lines.some((line) => line.includes('…'))) expect(lines.join(' ')).toBe(given.join(' '));
		})
	);
});
