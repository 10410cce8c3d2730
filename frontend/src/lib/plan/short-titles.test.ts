import { expect, test } from 'vitest';
import { shortTitles } from './short-titles.ts';

test('a short title leaves out what all of a lane begin with', () => {
	expect(shortTitles(['Move to pair 4', 'Move to pair 5'])).toEqual(['pair 4', 'pair 5']);
	expect(shortTitles(['Move home', 'Move to pair 5'])).toEqual(['Move home', 'Move to pair 5']);
	expect(shortTitles(['Move', 'Move to pair 5'])).toEqual(['Move', 'Move to pair 5']);
	expect(shortTitles(['Lift', 'Lift'])).toEqual(['Lift', 'Lift']);
});
