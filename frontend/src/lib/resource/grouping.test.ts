import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Variable } from '#lib/contract.ts';
import { Grouping, groupsOf, KEY_ROWS } from './grouping.ts';

function variable(kind: Variable['kind'], resource: string | null, value: Variable['value'] = null): Variable {
	return { resource, kind, domain: [false, true], dual_approval: false, value, since: null, awaits: null, belief: null, commanded_by: null };
}

const kind = fc.constantFrom<Variable['kind']>('measured', 'output', 'estimated');
const resource = fc.constantFrom('robot', 'nutrunner', null);
const variables = fc
	.array(fc.tuple(kind, resource), { maxLength: 60 })
	.map((all) => Object.fromEntries(all.map(([kind, of], index) => [`${of ?? 'product'}.v${index}`, variable(kind, of)])));

test('every variable is counted with its resource, and shown there at most once', () => {
	fc.assert(
		fc.property(variables, (all) => {
			const groups = groupsOf(all);
			for (const [resource, { key, size, estimated }] of groups) {
				const mine = Object.entries(all).filter(([, each]) => each.resource === resource);
				expect(size).toBe(mine.length);
				expect(estimated).toBe(mine.every(([, each]) => each.kind === 'estimated'));
				const shown = key.flatMap(({ name, command }) => (command === null ? [name] : [name, command]));
				expect(new Set(shown).size).toBe(shown.length);
				for (const name of shown) expect(mine.map(([each]) => each)).toContain(name);
				if (size > 2 * KEY_ROWS) expect(key.length).toBeLessThanOrEqual(10);
			}
			expect([...groups.values()].reduce((sum, { size }) => sum + size, 0)).toBe(Object.keys(all).length);
		})
	);
});

test('other values of the same variables change no group', () => {
	const grouping = new Grouping();
	const before = grouping.of({ a: variable('measured', 'robot'), b: variable('output', 'robot') });
	expect(grouping.of({ a: variable('measured', 'robot', true), b: variable('output', 'robot') })).toBe(before);
	expect(grouping.of({ a: variable('measured', 'robot'), c: variable('output', 'robot') })).not.toBe(before);
});
