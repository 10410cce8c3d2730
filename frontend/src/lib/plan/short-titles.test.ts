import { expect, test } from 'vitest';
import { shortTitles } from './short-titles.ts';

test('a short title leaves out what those of a lane begin with', () => {
	expect(shortTitles(['Move to pair 4', 'Move to pair 5'])).toEqual(['pair 4', 'pair 5']);
	expect(shortTitles(['Move home', 'Move to pair 5'])).toEqual(['Move home', 'Move to pair 5']);
	expect(shortTitles(['Move', 'Move to pair 5'])).toEqual(['Move', 'Move to pair 5']);
	expect(shortTitles(['Lift', 'Lift'])).toEqual(['Lift', 'Lift']);
});

test('of several kinds each leaves out what those of its kind begin with', () => {
	expect(shortTitles(['Attach the tool', 'Move to above engine', 'Move to bolt pair 1', 'Move to bolt pair 2'])).toEqual([
		'Attach the tool',
		'above engine',
		'pair 1',
		'pair 2'
	]);
	expect(shortTitles(['Move to pair 4', 'Move to pair 5', 'Move to pair 4'])).toEqual(['pair 4', 'pair 5', 'pair 4']);
});

test('what would be told alike stays as it is', () => {
	const titles = ['Grip the oil filter', 'Grip the ladder frame', 'Leave the oil filter', 'Leave the ladder frame'];
	expect(shortTitles(titles)).toEqual(titles);
	expect(shortTitles([...titles, 'Leave the cover plate']).at(-1)).toBe('cover plate');
});
