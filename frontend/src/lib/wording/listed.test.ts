import { expect, test } from 'vitest';
import { listed } from './listed.ts';

test('three are named; of more it is said how many others there are', () => {
	expect(listed([])).toBe('');
	expect(listed(['A'])).toBe('A');
	expect(listed(['A', 'B'])).toBe('A and B');
	expect(listed(['A', 'B', 'C'])).toBe('A, B and C');
	expect(listed(['A', 'B', 'C', 'D'])).toBe('A, B and 2 more');
});
