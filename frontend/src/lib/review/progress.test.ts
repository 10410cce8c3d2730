import { expect, test } from 'vitest';
import { follow, type Heard, type Phase } from './progress.ts';

const AT_WORK: Heard = { live: true, production: 'waiting', tick: 900, state: null };

function through(...all: Heard[]): Phase[] {
	let phase: Phase = 'accepted';
	return all.map((heard) => (phase = follow(phase, heard, 900)));
}

test('the controller that ends is heard for a moment, then none, then one that prepares, then it runs', () => {
	expect(
		through(
			AT_WORK,
			{ ...AT_WORK, live: false },
			{ live: true, production: 'preparing', tick: 0, state: 'starting' },
			{ live: true, production: 'waiting', tick: 1, state: 'starting' },
			{ live: true, production: 'waiting', tick: 2, state: 'runs' },
			{ live: false, production: 'waiting', tick: 3, state: 'runs' }
		)
	).toEqual(['accepted', 'anew', 'anew', 'anew', 'runs', 'runs']);
});

test('one that was not seen to end is known by its ticks', () => {
	expect(through({ ...AT_WORK, tick: 3 }, { ...AT_WORK, tick: 4 })).toEqual(['anew', 'runs']);
});

test('one that cannot be started is undone, and what was said of an earlier try does not count', () => {
	const undone: Heard = { ...AT_WORK, state: 'undone' };
	expect(
		through(
			undone,
			{ ...AT_WORK, live: false },
			{ live: true, production: 'waiting', tick: 1, state: 'starting' },
			{ ...undone, live: false },
			{ ...undone, tick: 2 },
			{ ...AT_WORK, tick: 3 }
		)
	).toEqual(['accepted', 'anew', 'anew', 'anew', 'undone', 'undone']);
});

test('nothing is followed before it was accepted', () => {
	expect(follow('sent', { ...AT_WORK, live: false }, 900)).toBe('sent');
});
