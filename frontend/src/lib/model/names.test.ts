import { expect, test } from 'vitest';
import { badName } from './names.ts';

test('names are those that the language can read', () => {
	expect(badName('ability', 'move_to', ['move'])).toBeNull();
	expect(badName('ability', '', [])).toBe('empty');
	expect(badName('ability', ' a', [])).toBe('blank');
	expect(badName('ability', '2nd', [])).toBe('digit');
	expect(badName('ability', 'flytta-på', [])).toBe('sign');
	expect(badName('ability', 'implies', [])).toBe('word');
	expect(badName('ability', 'move', ['move'])).toBe('taken');
	expect(badName('ability', 'a'.repeat(101), [])).toBe('long');
	expect(badName('resource', 'operation', [])).toBe('operation');
	expect(badName('topic', '/robot/state', [])).toBeNull();
	expect(badName('topic', '/robot//state', [])).toBe('ros');
	expect(badName('message', 'robot_msgs/msg/State', [])).toBeNull();
	expect(badName('message', 'State', [])).toBe('message');
});
