import fc from 'fast-check';
import { expect, test } from 'vitest';
import { numbersText, readNumbers } from './numbers.ts';

test.each([
	['', []],
	['0, -1.57, 1.57', [0, -1.57, 1.57]],
	['[0.5; 1e-3;  .25]', [0.5, 0.001, 0.25]],
	['0,5; -1,57', [0.5, -1.57]],
	['+1\t2\n3', [1, 2, 3]],
	['0,5', [0, 5]]
])('%j is read', (text, numbers) => {
	expect(readNumbers(text)).toEqual(numbers);
});

test.each(['up', '1, two', '1..2', '0x10', 'NaN', 'Infinity', '1e7', Array(33).fill('0').join(' ')])('%j is no row of angles', (text) => {
	expect(readNumbers(text)).toBeNull();
});

test('what is written is read again, to a millionth', () => {
	fc.assert(
		fc.property(fc.array(fc.double({ min: -1e5, max: 1e5, noNaN: true }), { maxLength: 32 }), (numbers) => {
			const read = readNumbers(numbersText(numbers));
			expect(read).toHaveLength(numbers.length);
			for (const [at, number] of numbers.entries()) expect(Math.abs((read?.[at] ?? NaN) - number)).toBeLessThan(1e-5);
		})
	);
});
