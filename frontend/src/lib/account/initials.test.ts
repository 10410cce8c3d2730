import { expect, test } from 'vitest';
import { initialsOf } from './initials.ts';

test.each([
	['Eva Lind', 'EL'],
	['Ina', 'I'],
	['anna maria björk', 'AB'],
	['  Åsa   Öberg ', 'ÅÖ'],
	['𝒳 Y', '𝒳Y'],
	['', '?']
])('%s is %s where there is room for two letters', (name, letters) => {
	expect(initialsOf(name)).toBe(letters);
});
