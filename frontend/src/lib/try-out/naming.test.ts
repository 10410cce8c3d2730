import { expect, test } from 'vitest';
import { nameFor } from './naming.ts';

test('a title becomes a name', () => {
	expect(nameFor('The robot falls silent', [])).toBe('the_robot_falls_silent');
	expect(nameFor(' Åter: på väg! ', [])).toBe('ater_pa_vag');
	expect(nameFor('3 pairs', [])).toBe('test_3_pairs');
	expect(nameFor('装置', [])).toBe('test');
});

test('that is not taken', () => {
	expect(nameFor('Fine', ['fine', 'fine_2'])).toBe('fine_3');
});
