import { expect, test } from 'vitest';
import { shapeOf } from './shape.svelte.ts';

test('who wears a watch knows best what it is, then its browser, and then its sides', () => {
	const [even, tall] = [[192, 192], [192, 228]] as const;
	expect(shapeOf(null, null, even)).toBe('round');
	expect(shapeOf(null, null, tall)).toBe('square');
	expect(shapeOf(null, 'square', even)).toBe('square');
	expect(shapeOf(null, 'round', tall)).toBe('round');
	expect(shapeOf('square', 'round', even)).toBe('square');
	expect(shapeOf('round', 'square', tall)).toBe('round');
	// What was kept may be anything.
	expect(shapeOf('oval', null, even)).toBe('round');
	// A bar of the browser's own, or a flat end, makes no round screen a rectangular one.
	expect(shapeOf(null, null, [192, 184])).toBe('round');
});
