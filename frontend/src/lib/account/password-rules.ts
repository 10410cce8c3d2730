/**
 * What a password must be, said before it is chosen.
 *
 * The server decides; these are its rules, so that a person learns of a mistake while typing and not after sending.
 */
import { say } from '#lib/text/text.svelte.ts';

export const SHORTEST = 12;
export const LONGEST = 256;

/** The rules in words. */
export function passwordRules(): string {
	return say().door.password.rules(SHORTEST);
}

/** What is wrong with `password` for somebody called `name`, in words; null when nothing is. */
export function passwordTrouble(password: string, name: string): string | null {
	const length = [...password].length;
	if (length < SHORTEST) return say().door.password.short(length, SHORTEST);
	if (length > LONGEST) return say().door.password.long(length, LONGEST);
	const own = folded(name);
	if (own !== '' && folded(password).includes(own)) return say().door.password.named;
	if (new Set(password).size === 1) return say().door.password.repeated;
	return null;
}

/** Without regard to case, width and blanks around. */
function folded(text: string): string {
	return text.normalize('NFKC').toLowerCase().trim();
}
