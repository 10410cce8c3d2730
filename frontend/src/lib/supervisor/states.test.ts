import { expect, test } from 'vitest';
import type { Analysis } from '#lib/contract.ts';
import { countText, statesText } from './states.ts';

const NOTHING: Analysis = {
	pending: 'the safe states',
	pending_message: { id: 'pending.safe', arguments: {} },
	supervised: null,
	reachable_states: null,
	supervised_states: null,
	supervised_at_most: null,
	guarded: null,
	guards: null,
	lifted: null,
	findings: null
};

test.each([
	[0, '0'],
	[999, '999'],
	[22_512, '22\u202f512'],
	[29_478_425_088, '29\u202f478\u202f425\u202f088'],
	[3 ** 60, 'about 4.2 × 10^28']
])('%f states are said as %s', (states, text) => {
	expect(countText(states)).toBe(text);
});

test('the states are told as far as they are known', () => {
	expect(statesText(NOTHING)).toBe('');
	expect(statesText({ ...NOTHING, supervised: true, reachable_states: 180 })).toBe('180 states can be reached.');
	const all = { ...NOTHING, pending: null, pending_message: null, supervised: true, reachable_states: 180, supervised_states: 148 };
	expect(statesText(all)).toBe('180 states can be reached, 148 of them with the supervisor.');
	expect(statesText({ ...NOTHING, supervised: true, supervised_at_most: 22_512 })).toBe(
		'At most 22\u202f512 states can be reached with the supervisor.'
	);
	expect(statesText({ ...NOTHING, supervised: false, reachable_states: 180 })).toBe(
		'There is no supervisor, so nothing is started.'
	);
});
