import { expect, test } from 'vitest';
import type { Alarm } from '#lib/contract.ts';
import { namedAlarm, nextText, stateText, toneOf } from './standing.ts';

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

test('the alarm that is named is the most urgent one that is not over, and nobody’s own problem', () => {
	const alarm = (text: string, more: Partial<Alarm>): Alarm =>
		({ text, priority: 'medium', state: 'unacknowledged', group: 'device', since: 1, ...more }) as Alarm;
	const medium = alarm('silent', {});
	const seen = alarm('seen', { state: 'acknowledged', since: 9 });
	const rest = [
		alarm('problem', { group: 'people', priority: 'high' }),
		alarm('nothing on /robot/state', { group: 'communication', priority: 'high' }),
		alarm('over', { state: 'returned', priority: 'high' }),
		alarm('shelved', { state: 'shelved' }),
		alarm('notice', { priority: 'low' })
	];
	expect(namedAlarm(rest)).toBeUndefined();
	expect(namedAlarm([...rest, seen, medium])).toBe(medium);
	const newer = alarm('newer', { since: 2 });
	expect(namedAlarm([medium, newer])).toBe(newer);
	const high = alarm('high', { priority: 'high', state: 'acknowledged' });
	expect(namedAlarm([medium, newer, high])).toBe(high);
});

test('what comes next is told with about when, as far as that is known', () => {
	const next = { title: 'Place bolts', at: 108 };
	expect(nextText(null, 100)).toBe('');
	expect(nextText(undefined, null)).toBe('');
	expect(nextText(next, 100)).toBe('Place bolts in about 8 s');
	expect(nextText(next, -25)).toBe('Place bolts in about 2 min');
	// What was expected and has not come yet still comes.
	expect(nextText(next, 120)).toBe('Place bolts soon');
	expect(nextText({ ...next, at: null }, 100)).toBe('Next: Place bolts');
});
