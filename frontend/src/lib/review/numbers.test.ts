import { expect, test } from 'vitest';
import type { Revision } from '#lib/contract.ts';
import { numberOf, runningOne, titleOfChange } from './numbers.ts';

const revision = (id: string, running = false): Revision => ({ id, name: id, message: '', by: '', time: 0, running, draft: false, approved_by: [], changes_requested_by: [] });

test('revisions are counted from the oldest', () => {
	const revisions = [revision('c'), revision('b', true), revision('a')];
	expect(revisions.map(({ id }) => numberOf({ revisions }, id))).toEqual([3, 2, 1]);
	expect(numberOf({ revisions }, 'x')).toBeNull();
	expect(runningOne({ revisions, saved: false, running: true })?.id).toBe('b');
	expect(runningOne(null)).toBeNull();
});

test('a change is called what its message begins with, or by its name', () => {
	expect(titleOfChange({ name: 'Limits', message: ' Shorter limits \n\nAs the shift said.' })).toBe('Shorter limits');
	expect(titleOfChange({ name: 'Limits', message: '' })).toBe('Limits');
});
