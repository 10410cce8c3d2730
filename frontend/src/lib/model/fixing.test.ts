import { expect, test } from 'vitest';
import { fixed } from './fixing.ts';

const TEXT = 'a:\n  when: robott.pose == home and robot.pose_2 == pose\n';

test('the first whole word from the place on is written anew, and nothing else', () => {
	expect(fixed(TEXT, { line: 2, column: 9 }, { was: 'robott.pose', now: 'robot.pose' })).toBe('a:\n  when: robot.pose == home and robot.pose_2 == pose\n');
	expect(fixed(TEXT, { line: 2, column: 20 }, { was: 'pose', now: 'position' })).toBe('a:\n  when: robott.pose == home and robot.pose_2 == position\n');
});

test('what stands there no more is not touched', () => {
	expect(fixed(TEXT, { line: 2, column: 9 }, { was: 'robo', now: 'robot' })).toBeNull();
	expect(fixed(TEXT, { line: 9, column: 1 }, { was: 'robott', now: 'robot' })).toBeNull();
	expect(fixed(TEXT, { line: 2, column: 30 }, { was: 'robott.pose', now: 'robot.pose' })).toBeNull();
});
