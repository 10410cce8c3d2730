import { expect, test } from 'vitest';
import { addressOf, besideExamples, besideText, lookedAt } from './address.ts';

const at = (query: string) => lookedAt(new URLSearchParams(query));
const USUAL = { example: null, entry: 'station.yaml', place: null, ability: null, graph: false, text: true, panel: null, examples: false };

test('what is looked at stands in the address', () => {
	expect(at('')).toEqual(USUAL);
	expect(at('entry=resources/robot.yaml:abilities&text=off')).toEqual({ ...USUAL, entry: 'resources/robot.yaml:abilities', text: false });
	expect(at(addressOf({ entry: 'operations.yaml', text: false }).split('?')[1] ?? '')).toEqual({ ...USUAL, entry: 'operations.yaml', text: false });
});

test('a line of a file, or an ability of the station, can be asked for instead of an entry', () => {
	expect(at('file=operations.yaml&line=7')).toEqual({ ...USUAL, entry: null, place: { file: 'operations.yaml', line: 7 } });
	expect(at('file=operations.yaml&line=x').place).toEqual({ file: 'operations.yaml', line: 1 });
	expect(at('file=operations.yaml&line=7&entry=a').place).toBeNull();
	expect(at('ability=robot.move_to(home)')).toEqual({ ...USUAL, entry: null, ability: 'robot.move_to(home)' });
	expect(at('ability=robot.move_to(home)&entry=a').ability).toBeNull();
});

test('an address can ask for one of those below the form', () => {
	expect(at('panel=guards')).toEqual({ ...USUAL, panel: 'guards' });
	expect(at('panel=everything').panel).toBeNull();
	expect(at('view=graph&thing=topic%3A/a').graph).toBe(true);
});

test('the file is shown or hidden whatever is looked at', () => {
	expect(besideText(new URLSearchParams('ability=robot.stop'), false)).toBe('/model?ability=robot.stop&text=off');
	expect(besideText(new URLSearchParams('ability=robot.stop&text=off'), true)).toBe('/model?ability=robot.stop');
});

test('the example stations are asked for and put away whatever is looked at', () => {
	expect(besideExamples(new URLSearchParams('entry=a'), true)).toBe('/model?entry=a&examples=on');
	expect(at('entry=a&examples=on').examples).toBe(true);
	expect(besideExamples(new URLSearchParams('examples=on'), false)).toBe('/model');
});
