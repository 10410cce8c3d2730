import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Person } from '#lib/contract.ts';
import { changeOf, differences } from './changes.ts';

const EVA: Person = {
	id: 'p1',
	name: 'Eva',
	role: 'operator',
	created: 0,
	disabled: false,
	must_change_password: false,
	issuer: null,
	revision: 3,
	sessions: 1
};
const roles = fc.constantFrom('viewer', 'operator', 'engineer', 'administrator');
const people = fc.record({ role: roles, disabled: fc.boolean() }).map((rest) => ({ ...EVA, ...rest }) as Person);
const choices = fc.record({ role: fc.option(roles), disabled: fc.option(fc.boolean()) });

describe('a change', () => {
	test('makes the person as chosen, and leaves alone what was not chosen', () => {
		fc.assert(
			fc.property(people, choices, (person, choice) => {
				const after = { ...person, ...changeOf(person, choice) };
				expect(after).toEqual({
					...person,
					role: choice.role ?? person.role,
					disabled: choice.disabled ?? person.disabled
				});
			})
		);
	});

	test('of nothing is not sent', () => {
		expect(changeOf(EVA, { role: 'operator', disabled: false })).toBeNull();
		expect(changeOf(EVA, { role: null, disabled: null })).toBeNull();
	});
});

test('what another changed meanwhile is said, each thing with its old and its new value', () => {
	expect(differences(EVA, { ...EVA, role: 'engineer', disabled: true, revision: 5 })).toEqual([
		'Role: operator → engineer',
		'Access: may sign in → disabled'
	]);
	expect(differences(EVA, { ...EVA, must_change_password: true })).toEqual(['A temporary password was given']);
	expect(differences(EVA, { ...EVA, revision: 4 })).toEqual([]);
});
