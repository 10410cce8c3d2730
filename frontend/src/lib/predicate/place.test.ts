import { expect, test } from 'vitest';
import type { TextPlace } from '#lib/contract.ts';
import { refusalOf } from '#lib/rest/refusal.ts';
import { placeOf } from './place.ts';

function refused(place?: TextPlace | null): ReturnType<typeof refusalOf> {
	const problem = { type: '/problems/bad-predicate', title: 'x', status: 422, detail: 'x', errors: [], place };
	return refusalOf(422, JSON.stringify(problem));
}

test('the place is where the parser says it is', () => {
	const unknown = { start: 0, end: 11, message: 'there is no `robbot.pose`' };
	expect(placeOf(refused(unknown), 'robbot.pose == home')).toEqual(unknown);
	const missing = { start: 13, end: 13, message: 'something is missing' };
	expect(placeOf(refused(missing), 'robot.pose ==')).toEqual(missing);
});

test('characters are counted as the parser counts them', () => {
	const found = placeOf(refused({ start: 8, end: 9, message: 'what is this' }), 'pose == 🔩 ');
	expect(found).toEqual({ start: 8, end: 10, message: 'what is this' });
});

test('none is made up', () => {
	expect(placeOf(null, 'x')).toBeNull();
	expect(placeOf(refused(null), 'x')).toBeNull();
	expect(placeOf(refused(), 'x')).toBeNull();
	expect(placeOf(refused({ start: 39, end: 40, message: 'what' }), 'short')).toBeNull();
});
