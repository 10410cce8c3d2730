import { expect, test } from 'vitest';
import { drawnAt } from './drawn-state.ts';

const IMAGE = '/api/v1/instructions/place.svg#pair_1';
const state = (value: string): string => drawnAt(IMAGE, { 'bolts[pair_1]': { value }, mode: { value: true } });

test('a drawing is read again when what it shows is another, and keeps the part that is marked', () => {
	expect(state('placed')).toMatch(/^\/api\/v1\/instructions\/place\.svg\?state=\w+#pair_1$/);
	expect(state('placed')).toBe(state('placed'));
	expect(state('tightened')).not.toBe(state('placed'));
	expect(drawnAt('/a.svg', { 'b[c]': { value: 1 } })).toMatch(/^\/a\.svg\?state=\w+$/);
});

test('what shows no state stays as it is', () => {
	expect(drawnAt(IMAGE, undefined)).toBe(IMAGE);
	expect(drawnAt(IMAGE, { mode: { value: true } })).toBe(IMAGE);
	expect(drawnAt('/a.png', { 'b[c]': { value: 1 } })).toBe('/a.png');
});
