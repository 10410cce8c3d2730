import { expect, test } from 'vitest';
import { follow, type Heard, type Phase } from './progress.ts';

const AT_WORK: Heard = { live: true, production: 'waiting', tick: 900 };

function through(...all: Heard[]): Phase[] {
	let phase: Phase = 'accepted';
	return all.map((heard) => (phase = follow(phase, heard, 900)));
}

test('the controller that ends is heard for a moment, then none, then one that prepares, then it runs', () => {
	expect(
		through(
			AT_WORK,
			{ ...AT_WORK, live: false },
			{ live: true, production: 'preparing', tick: 0 },
			{ live: true, production: 'waiting', tick: 1 },
			{ live: false, production: 'waiting', tick: 2 }
		)
	).toEqual(['accepted', 'anew', 'anew', 'runs', 'runs']);
});

test('one that was not seen to end is known by its ticks', () => {
	expect(through({ ...AT_WORK, tick: 3 }, { ...AT_WORK, tick: 4 })).toEqual(['anew', 'runs']);
});

test('nothing is followed before it was accepted', () => {
	expect(follow('sent', { ...AT_WORK, live: false }, 900)).toBe('sent');
});
