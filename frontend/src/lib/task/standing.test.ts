import { expect, test } from 'vitest';
import { stateText, toneOf } from './standing.ts';

test('what is most in the way is said of the station: that it stands, then what is not heard, then what needs help', () => {
	expect(stateText('working', [], [])).toBe('');
	expect(stateText('working', [], ['Robot UR10'])).toBe('Needs help: Robot UR10');
	expect(stateText('silent', ['Smart nutrunner'], ['Robot UR10'])).toBe('No contact: Smart nutrunner');
	expect(stateText('held', ['Smart nutrunner'], ['Robot UR10'])).toBe('Held: keep clear');
});

test('what wants help is told from what wants distance, and from what is as it should be', () => {
	expect(toneOf('working', [], [])).toBe('plain');
	for (const [silent, failing] of [[['Smart nutrunner'], []], [[], ['Robot UR10']]] as const)
		expect(toneOf('working', silent, failing)).toBe('high');
	expect(toneOf('stopped', [], [])).toBe('high');
	for (const standing of ['held', 'restart'] as const) expect(toneOf(standing, [], ['Robot UR10'])).toBe('medium');
	// A station that was not started, or that somebody has paused, needs nobody's help.
	for (const standing of ['waiting', 'preparing', 'paused'] as const) expect(toneOf(standing, ['Robot UR10'], [])).toBe('plain');
});
