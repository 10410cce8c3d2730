/** What an administrator changes about a person, upon what was seen, when others may be changing it too. */
import type { Person, Role } from '#lib/contract.ts';

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
	return disabled ? 'disabled' : 'may sign in';
}

/** What differs between a person as seen `before` and as found `after`, for a person to read. */
export function differences(before: Person, after: Person): string[] {
	const said: string[] = [];
	if (before.role !== after.role) said.push(`Role: ${before.role} → ${after.role}`);
	if (before.disabled !== after.disabled)
		said.push(`Access: ${signInText(before.disabled)} → ${signInText(after.disabled)}`);
	if (before.name !== after.name) said.push(`Name: ${before.name} → ${after.name}`);
	if (before.must_change_password !== after.must_change_password)
		said.push(after.must_change_password ? 'A temporary password was given' : 'The temporary password was changed');
	return said;
}
