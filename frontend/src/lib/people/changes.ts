/** What an administrator changes about a person, upon what was seen, when others may be changing it too. */
import type { Person, Role } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** What was chosen; null: stays as it is. */
export interface Choice {
	readonly role: Role | null;
	readonly disabled: boolean | null;
}

/** What is to be sent so that `person` becomes as chosen; null when that is so already. */
export function changeOf(person: Person, choice: Choice): Partial<Pick<Person, 'role' | 'disabled'>> | null {
	const role = choice.role !== null && choice.role !== person.role;
	const disabled = choice.disabled !== null && choice.disabled !== person.disabled;
	if (!role && !disabled) return null;
	return { ...(role && { role: choice.role }), ...(disabled && { disabled: choice.disabled }) };
}

/** How it is said whether a person may sign in. */
export function signInText(disabled: boolean): string {
	const { people } = say().account;
	return disabled ? people.disabled : people.mayText;
}

/** What differs between a person as seen `before` and as found `after`, for a person to read. */
export function differences(before: Person, after: Person): string[] {
	const { people, roles, name } = say().account;
	const said: string[] = [];
	if (before.role !== after.role) said.push(people.differs(people.role, roles[before.role].name, roles[after.role].name));
	if (before.disabled !== after.disabled)
		said.push(people.differs(people.access, signInText(before.disabled), signInText(after.disabled)));
	if (before.name !== after.name) said.push(people.differs(name, before.name, after.name));
	if (before.must_change_password !== after.must_change_password)
		said.push(after.must_change_password ? people.wasGiven : people.wasChanged);
	return said;
}
