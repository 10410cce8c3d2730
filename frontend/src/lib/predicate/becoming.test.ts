import { expect, test } from 'vitest';
import { becoming } from './becoming.ts';

test('what is offered is that the variable becomes another value than it has', () => {
	expect(becoming('robot.pose', { value: 'home', domain: ['home', 'above'] })).toBe('robot.pose == above');
	expect(becoming('robot.pose', { value: null, domain: ['home', 'above'] })).toBe('robot.pose == home');
	expect(becoming('robot.moving', { value: false, domain: [false, true] })).toBe('robot.moving');
	expect(becoming('robot.moving', { value: true, domain: [false, true] })).toBe('not robot.moving');
	expect(becoming('tray.parts', { value: 0, domain: [0, 1, 2] })).toBe('tray.parts == 1');
});
