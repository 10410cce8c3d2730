import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { listRead, listShown, pairsBad, pairsFit, pairsRead, pairsShown, scalarRead, scalarShown } from './pairs.ts';

const number = fc.double({ noNaN: true, noDefaultInfinity: true }).map((each) => (Object.is(each, -0) ? 0 : each));
const word = fc.string().filter((each) => !each.includes("'") && each === each.trim() && each !== '');
const scalar = fc.oneof(fc.boolean(), number, word);
const name = word;
/** A name of a model, or several. */
const member = fc
	.array(fc.stringMatching(/^[A-Za-z_]\w*$/), { minLength: 1 })
	.map((names) => (names.length === 1 ? names[0] : names));

describe('what is written is read as it was', () => {
	test('scalars', () => {
		fc.assert(fc.property(scalar, (value) => void expect(scalarRead(scalarShown(value))).toEqual(value)));
	});
	test('lists of scalars', () => {
		fc.assert(fc.property(fc.array(scalar), (values) => void expect(listRead(listShown(values))).toEqual(values)));
	});
	test.each([
		['named', fc.dictionary(name, scalar)],
		['numbers', fc.dictionary(name, fc.array(fc.oneof(number, fc.constant(null)), { minLength: 1 }))],
		['words', fc.dictionary(name, fc.array(word, { minLength: 1 }))],
		[
			'bounds',
			fc.dictionary(name, fc.oneof(fc.record({ between: fc.tuple(number, number) }), fc.record({ in: fc.array(fc.boolean(), { minLength: 1 }) })))
		],
		['rows', fc.array(fc.record({ when: fc.array(scalar, { minLength: 1 }), gives: fc.array(scalar, { minLength: 1 }) }))],
		['couples', fc.array(fc.tuple(member, member))]
	] as const)('%s', (kind, values) => {
		fc.assert(
			fc.property(values as fc.Arbitrary<never>, (value) => {
				expect(pairsFit(kind, value)).toBe(true);
				expect(pairsRead(kind, pairsShown(kind, value))).toEqual(value);
				expect(pairsBad(kind, pairsShown(kind, value))).toBeNull();
			})
		);
	});
});

test('what makes no sense is said', () => {
	expect(pairsBad('numbers', [['home', '0, far']])).toBe('number');
	expect(pairsBad('named', [['a', '1'], ['a', '2']])).toBe('twice');
	expect(pairsBad('named', [['a', ' ']])).toBe('pair');
	expect(pairsBad('rows', [['1', 'a'], ['1', 'b']])).toBeNull();
	expect(pairsFit('numbers', { home: ['far'] })).toBe(false);
	expect(pairsFit('named', { a: { b: 1 } })).toBe(false);
});
