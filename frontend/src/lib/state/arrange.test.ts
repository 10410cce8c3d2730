import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Force, Value, Variable } from '#lib/contract.ts';
import { estimate, view } from '#lib/testing/view.ts';
import { arrange, entriesOf, followsValues } from './arrange.ts';
import { EVERYTHING, KINDS, OF_NONE, SORTED_BY, criteriaOf, queryOf, sortedBy, type Criteria } from './criteria.ts';
import { STANDINGS, countsOf } from './standing.ts';

const said = (_: string, value: Value | null): string => (value === null ? 'unknown' : String(value).replaceAll('_', ' '));
const resources = {
	robot: { title: 'Robot arm', online: true, awaited_topics: [] },
	agv: { title: 'AGV', online: true, awaited_topics: [] }
};
const measured = (resource: string, value: Value | null, since = 900): Variable =>
	estimate({ resource, kind: 'measured', belief: null, value, since });
const force: Force = { value: 3, real: null, until: 1060, by: 'Eva', why: '' };
const shown = view({
	resources,
	variables: {
		'robot.target_pose': { ...measured('robot', 'above_engine', 990), kind: 'output' },
		'robot.pose': measured('robot', null, 950),
		'agv.speed': measured('agv', 10, 980),
		'agv.battery': measured('agv', 9, 970),
		'bolts[bolt_pair_2]': estimate({ belief: { writer: 'place', at: 900, evidence: [], unconfirmed_since: 950 } })
	},
	forces: { 'agv.speed': force },
	questions: [{ variable: 'bolts[bolt_pair_2]', believed: 'placed', so: { id: 'as-it-was', arguments: { text: 'so' } }, possible: ['empty'], because: [], because_messages: [] }]
});
const names = (criteria: Partial<Criteria>): readonly string[] =>
	arrange(entriesOf(shown, (name) => name), { ...EVERYTHING, ...criteria }, shown, said);

describe('the list of variables', () => {
	test('is by resource, kind and name at first; what belongs to no resource is above', () => {
		expect(names({})).toEqual(['bolts[bolt_pair_2]', 'agv.battery', 'agv.speed', 'robot.pose', 'robot.target_pose']);
	});

	test('is by what resources are called in it, and found by that and by their titles', () => {
		const called = entriesOf(shown, (name) => name, new Map([['robot', 'A robot']]));
		const found = (search: string): readonly string[] => arrange(called, { ...EVERYTHING, search }, shown, said);
		expect(found('')).toEqual(['bolts[bolt_pair_2]', 'robot.pose', 'robot.target_pose', 'agv.battery', 'agv.speed']);
		expect(found('a robot')).toEqual(found('robot arm'));
	});

	test.each([
		['pose robot', ['robot.pose', 'robot.target_pose']],
		['ARM above', ['robot.target_pose']],
		['bolt_pair_2', ['bolts[bolt_pair_2]']],
		['pair 2 plac', ['bolts[bolt_pair_2]']],
		['unknown', ['robot.pose']],
		['nowhere', []]
	])('has for %j what has all of these words in its name, title or value', (search, found) => {
		expect(names({ search })).toEqual(found);
	});

	test('can have one resource, one kind, or what is not as it should be, alone', () => {
		expect(names({ resource: 'agv' })).toEqual(['agv.battery', 'agv.speed']);
		expect(names({ resource: OF_NONE })).toEqual(['bolts[bolt_pair_2]']);
		expect(names({ kind: 'output' })).toEqual(['robot.target_pose']);
		expect(names({ only: ['unknown', 'forced'] })).toEqual(['agv.speed', 'robot.pose']);
		expect(names({ only: ['unconfirmed'] })).toEqual(names({ only: ['doubted'] }));
		expect(countsOf(shown)).toEqual({ unknown: 1, unconfirmed: 1, forced: 1, doubted: 1 });
	});

	test('is sorted by numbers as numbers, then by words, then what is unknown; by age the youngest first', () => {
		expect(names({ sort: 'value' }).slice(0, 2)).toEqual(['agv.battery', 'agv.speed']);
		expect(names({ sort: 'value' }).at(-1)).toBe('robot.pose');
		expect(names({ sort: 'age' })[0]).toBe('robot.target_pose');
	});
});

const values = fc.oneof(fc.boolean(), fc.integer(), fc.constantFrom('a', 'b_c', 'unknown'), fc.constant(null));
const stations = fc
	.dictionary(
		fc.string({ minLength: 1 }),
		fc.record({ resource: fc.constantFrom('robot', 'agv', null), kind: fc.constantFrom(...KINDS), value: values }),
		{ maxKeys: 12, noNullPrototype: true }
	)
	.map((all) =>
		view({
			resources,
			variables: Object.fromEntries(Object.entries(all).map(([name, rest]) => [name, estimate(rest)]))
		})
	);
const criteria: fc.Arbitrary<Criteria> = fc.record({
	search: fc.string().map((search) => search.trim()),
	resource: fc.constantFrom('', 'robot', OF_NONE),
	kind: fc.constantFrom('' as const, ...KINDS),
	only: fc.subarray([...STANDINGS]),
	sort: fc.constantFrom(...SORTED_BY),
	down: fc.boolean()
});

test('however it is sorted it has the same variables, each once', () => {
	fc.assert(
		fc.property(stations, criteria, (station, wanted) => {
			const all = (sorted: Partial<Criteria>): readonly string[] =>
				arrange(entriesOf(station, (name) => name), { ...wanted, ...sorted }, station, said);
			const found = all({});
			expect(new Set(found).size).toBe(found.length);
			for (const sort of SORTED_BY) expect([...all({ sort, down: true })].sort()).toEqual([...found].sort());
		})
	);
});

test('what does not follow values is the same whatever they are', () => {
	fc.assert(
		fc.property(stations, criteria, values, (station, wanted, value) => {
			if (followsValues(wanted)) return;
			const changed = Object.entries(station.variables).map(([name, each]) => [name, { ...each, value, since: 1 }]);
			const other = { ...station, variables: Object.fromEntries(changed) as typeof station.variables };
			const entries = entriesOf(station, (name) => name);
			expect(arrange(entries, wanted, other, said)).toEqual(arrange(entries, wanted, station, said));
		})
	);
});

describe('an address', () => {
	test('asks for what it was made of', () => {
		fc.assert(
			fc.property(criteria, (wanted) => {
				expect(criteriaOf(new URLSearchParams(queryOf(wanted)))).toEqual(wanted);
			})
		);
	});

	test('may say anything', () => {
		expect(criteriaOf(new URLSearchParams('kind=odd&only=forced,odd&sort=-odd&resource=robot'))).toEqual({
			...EVERYTHING,
			resource: 'robot',
			only: ['forced'],
			down: true
		});
		expect(queryOf(EVERYTHING)).toBe('');
	});
});

test('to sort by the same again is to sort the other way round', () => {
	const once = sortedBy(EVERYTHING, 'age');
	expect(once).toMatchObject({ sort: 'age', down: false });
	expect(sortedBy(once, 'age')).toMatchObject({ sort: 'age', down: true });
	expect(sortedBy(sortedBy(once, 'age'), 'age')).toEqual(EVERYTHING);
});
