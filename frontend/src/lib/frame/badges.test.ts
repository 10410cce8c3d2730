import { describe, expect, it } from 'vitest';
import { reviewBadge } from './badges.svelte.ts';

const WAITS = { id: 'a', number: 12, name: 'Bolts', by: 'Eva', time: 0 };

describe('beside the name of the page on which changes are reviewed', () => {
	it('stands how many are not deployed', () => {
		expect(reviewBadge({ waits: null, changes: 0 })).toBeNull();
		expect(reviewBadge({ waits: null, changes: 3 })).toEqual({ text: '3', means: '3 changes are not deployed', priority: null });
	});

	it('stands before that who waits for an approval', () => {
		const means = 'Revision 12, “Bolts”, by Eva waits for a second person’s approval.';
		expect(reviewBadge({ waits: WAITS, changes: 3 })).toEqual({ text: '!', means, priority: null });
	});
});
