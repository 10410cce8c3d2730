import { describe, expect, test } from 'vitest';
import { badValue, fits, readFrom, shownAs } from './codecs.ts';
import type { FieldKind, FieldShape } from './shape.ts';

const shape = (kind: FieldKind, rest: Partial<FieldShape> = {}): FieldShape => ({ kind, help: '', required: false, ...rest });

describe('values in a form', () => {
	test('what is not touched stays what it is', () => {
		const kept = [
			['text', 'a title'],
			['number', 2.5],
			['flag', true],
			['choice', 'in'],
			['interval', [0.5, 1]],
			['interval', 2],
			['value', false],
			['value', 3],
			['value', 'home'],
			['predicate', 'a == b'],
			['predicate', true],
			['texts', ['a', 'b']],
			['names', { pair: 'bolt_pair' }],
			['zone', { robot: 'pose == home', other: false }],
			['predicates', ['a', true]]
		] as const;
		for (const [kind, value] of kept) {
			const field = shape(kind, { choices: ['in', 'out'] });
			expect(fits(kind, value), kind).toBe(true);
			expect(readFrom(field, shownAs(field, value)), kind).toEqual(value);
		}
	});

	test('what is empty is left out, where it may be', () => {
		for (const kind of ['text', 'number', 'choice', 'value', 'predicate'] as const)
			expect(readFrom(shape(kind), ''), kind).toBeUndefined();
		expect(readFrom(shape('texts'), ['', ' '])).toBeUndefined();
		expect(readFrom(shape('texts', { required: true }), [''])).toEqual([]);
		expect(readFrom(shape('flag', { otherwise: true }), true)).toBeUndefined();
		expect(readFrom(shape('flag', { otherwise: true }), false)).toBe(false);
	});

	test('what a form cannot show is written as YAML', () => {
		expect(fits('text', ['a'])).toBe(false);
		expect(fits('texts', [{ a: 1 }])).toBe(false);
		expect(fits('interval', [1, 2, 3])).toBe(false);
		expect(fits('choice', { depth: 3 })).toBe(false);
		expect(fits('yaml', undefined)).toBe(false);
	});

	test('what is no value is not one, with why', () => {
		const number = shape('number', { least: 0, most: 10 });
		expect(badValue(number, '2,5')).toBeNull();
		expect(badValue(number, 'two')).toBe('number');
		expect(badValue(number, '-1')).toBe('least');
		expect(badValue(number, '11')).toBe('most');
		expect(badValue(shape('number', { whole: true }), '1.5')).toBe('whole');
		expect(badValue(shape('number', { above: 0 }), '0')).toBe('least');
		expect(badValue(shape('interval'), ['2', '1'])).toBe('order');
		expect(badValue(shape('interval'), ['', '1'])).toBe('pair');
		expect(badValue(shape('names'), [['a', 'b'], ['a', 'c']])).toBe('twice');
		expect(badValue(shape('names'), [['1a', 'b']])).toBe('name');
		expect(badValue(shape('text', { required: true }), ' ')).toBe('required');
	});
});
