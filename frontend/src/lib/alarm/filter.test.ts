import fc from 'fast-check';
import { expect, test } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { filterOf, passes, queryOf, type Filter } from './filter.ts';
import { PRIORITIES, STATES } from './priority.ts';

const NOTHING = { resources: [], topics: [], restart: false };
const EVERYTHING: Filter = { state: null, priority: null, resource: null };

test('a filter that was put into an address is read from it again', () => {
	const filters = fc.record({
		state: fc.constantFrom(null, ...STATES),
		priority: fc.constantFrom(null, ...PRIORITIES),
		resource: fc.option(fc.string({ minLength: 1 }))
	});
	fc.assert(
		fc.property(filters, (filter) => {
			expect(filterOf(new URLSearchParams(queryOf(filter)))).toEqual(filter);
		})
	);
});

test('an address that means nothing asks for everything', () => {
	expect(filterOf(new URLSearchParams('state=angry&priority=9&resource='))).toEqual(EVERYTHING);
	expect(queryOf(EVERYTHING)).toBe('');
});

test('an alarm passes where all that is asked for is so', () => {
	const about = { ...NOTHING, resources: ['robot'] };
	const shelved = alarm({ state: 'shelved', priority: 'low' });
	expect(passes({ state: 'shelved', priority: 'low', resource: 'robot' }, ['a', shelved], about)).toBe(true);
	expect(passes({ ...EVERYTHING, state: 'returned' }, ['a', shelved], about)).toBe(false);
	expect(passes({ ...EVERYTHING, priority: 'high' }, ['a', shelved], about)).toBe(false);
	expect(passes({ ...EVERYTHING, resource: 'tool' }, ['a', shelved], about)).toBe(false);
});
