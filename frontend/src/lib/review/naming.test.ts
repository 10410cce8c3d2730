import { expect, test } from 'vitest';
import type { Revision } from '#lib/contract.ts';
import { nameTrouble } from './naming.ts';

function revision(name: string, draft = false): Revision {
	return { id: 'a'.repeat(40), name, message: '', by: 'Erik', time: 0, running: false, draft, approved_by: [], changes_requested_by: [] };
}

const KNOWN = [revision('Longer table'), revision('First')];

test('a revision needs a name of its own', () => {
	expect(nameTrouble('Shorter table', KNOWN)).toBeNull();
	expect(nameTrouble('  ', KNOWN)).toEqual({ why: 'empty' });
	expect(nameTrouble('x'.repeat(101), KNOWN)).toEqual({ why: 'long' });
	expect(nameTrouble(' Longer   table ', KNOWN)).toEqual({ why: 'taken', name: 'Longer table' });
});

test('what is the last revision already is not saved again', () => {
	expect(nameTrouble('Other', [revision('Longer table', true)])).toEqual({ why: 'same', name: 'Longer table' });
	expect(nameTrouble('Other', [revision('Longer table'), revision('First', true)])).toBeNull();
});
