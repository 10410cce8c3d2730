import { expect, test } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { saidState } from './notice.ts';

test('what nobody has to acknowledge is a notice until somebody has looked at it', () => {
	const low = { priority: 'low', state: 'acknowledged' } as const;
	expect(saidState(alarm({ ...low, by: null }))).toBe('notice');
	expect(saidState(alarm({ ...low, by: 'Eva' }))).toBe('acknowledged');
	expect(saidState(alarm({ priority: 'medium', state: 'acknowledged', by: null }))).toBe('acknowledged');
});
