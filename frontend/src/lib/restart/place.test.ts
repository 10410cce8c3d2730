import { expect, test } from 'vitest';
import { refusalOf } from '#lib/rest/refusal.ts';
import { placeOf } from './place.ts';

function refused(detail: string, kind = 'bad-predicate'): ReturnType<typeof refusalOf> {
	return refusalOf(422, JSON.stringify({ type: `/problems/${kind}`, title: 'x', status: 422, detail }));
}

test('the place is where the parser says it is', () => {
	expect(placeOf(refused('character 1, `robbot.pose`: there is no `robbot.pose`: look'), 'robbot.pose == home')).toEqual({
		start: 0,
		end: 11,
		message: 'there is no `robbot.pose`: look'
	});
	expect(placeOf(refused('character 14: something is missing'), 'robot.pose ==')).toEqual({
		start: 13,
		end: 13,
		message: 'something is missing'
	});
});

test('none is made up', () => {
	expect(placeOf(null, 'x')).toBeNull();
	expect(placeOf(refused('There is no plan.', 'no-plan'), 'x')).toBeNull();
	expect(placeOf(refused('character 1, `robot`: what'), 'nutrunner')).toBeNull();
	expect(placeOf(refused('character 40: what'), 'short')).toBeNull();
});
