import { expect, test } from 'vitest';
import { addressOf, lookedAt } from './address.ts';

const at = (query: string) => lookedAt(new URLSearchParams(query));

test('what is looked at stands in the address', () => {
	expect(at('')).toEqual({ entry: 'station.yaml', place: null, text: true });
	expect(at('entry=resources/robot.yaml:abilities&text=off')).toEqual({ entry: 'resources/robot.yaml:abilities', place: null, text: false });
	expect(at(addressOf({ entry: 'operations.yaml', text: false }).split('?')[1] ?? '')).toEqual({ entry: 'operations.yaml', place: null, text: false });
});

test('a line of a file can be asked for instead of an entry', () => {
	expect(at('file=operations.yaml&line=7')).toEqual({ entry: null, place: { file: 'operations.yaml', line: 7 }, text: true });
	expect(at('file=operations.yaml&line=x').place).toEqual({ file: 'operations.yaml', line: 1 });
	expect(at('file=operations.yaml&line=7&entry=a').place).toBeNull();
});
