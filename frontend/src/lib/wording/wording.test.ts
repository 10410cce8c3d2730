import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { modeMeaning, plannerTime } from './station.ts';
import { unbroken } from './unbroken.ts';
import { ageText, agoText, durationText } from './time.ts';
import { valueText, variableName } from './values.ts';

describe('an age', () => {
	test.each([
		[0, '0 ms'],
		[87, '80 ms'],
		[999, '990 ms'],
		[1000, '1.0 s'],
		[9999, '9.9 s'],
		[10_000, '10 s'],
		[119_999, '119 s'],
		[120_000, '2 min'],
		[7_200_000, '2 h'],
		[172_800_000, '2 days']
	])('of %i ms is said as %s', (age, text) => {
		expect(ageText(age)).toBe(text);
	});
});

test('when something was is said in whole seconds, and never as now on a view that is old', () => {
	expect([0.4, 2.9, 12.3, 130, -1].map((seconds) => agoText(seconds, true))).toEqual([
		'just now',
		'2 s ago',
		'12 s ago',
		'2 min ago',
		'just now'
	]);
	expect([0.4, 12.3].map((seconds) => agoText(seconds, false))).toEqual(['0 s before', '12 s before']);
});

describe('a duration', () => {
	test.each([
		[-3, '0:00'],
		[7.9, '0:07'],
		[750, '12:30'],
		[3723, '1:02:03']
	])('of %f s is said as %s', (seconds, text) => {
		expect(durationText(seconds)).toBe(text);
	});

	test('reads back as its whole seconds', () => {
		fc.assert(
			fc.property(fc.nat(1_000_000), (seconds) => {
				const back = durationText(seconds)
					.split(':')
					.reduce((sum, part) => sum * 60 + Number(part), 0);
				expect(back).toBe(seconds);
			})
		);
	});
});

test('a variable loses the name of its resource and its underscores', () => {
	expect(variableName('robot.target_pose', 'robot')).toBe('target pose');
	expect(variableName('robot_arm.pose', 'robot')).toBe('robot arm.pose');
	expect(variableName('bolts[bolt_pair_1]', null)).toBe('bolts · bolt pair 1');
});

test('values are said in words', () => {
	expect([true, false, 3, 'above_engine'].map(valueText)).toEqual(['yes', 'no', '3', 'above engine']);
});

test('no mode is said to carry anything out before production is started', () => {
	expect(modeMeaning({ mode: 'automatic', production: 'started' })).toBe('Operations are carried out.');
	expect(modeMeaning({ mode: 'automatic', production: 'waiting' })).toMatch(/^Devices get no commands/);
	expect(modeMeaning({ mode: 'restart', production: 'waiting' })).toMatch(/^Operations wait.* before production starts/);
});

test('the time of the planner keeps two figures or so', () => {
	expect([0.41, 12.3, 1234].map(plannerTime)).toEqual(['0.4 ms', '12 ms', '1.2 s']);
});

test('a word and its index stay on one line', () => {
	expect(unbroken('Place bolt pair 5, then pair 12')).toBe('Place bolt pair\u00a05, then pair\u00a012');
	expect(unbroken('since 14:05, 40 % of 3 parts')).toBe('since 14:05, 40\u00a0% of\u00a03 parts');
	expect(unbroken('did not finish within 40 s')).toBe('did not finish within\u00a040\u00a0s');
});
