/**
 * What a password must be, said before it is chosen.
 *
 * The server decides; these are its rules, so that a person learns of a mistake while typing and not after sending.
 */

export const SHORTEST = 12;
export const LONGEST = 256;

export const RULES =
	`At least ${SHORTEST} characters, any characters; a few words are well. ` +
	'It must not contain the name, nor be one character over and over.';

/** What is wrong with `password` for somebody called `name`, in words; null when nothing is. */
export function passwordTrouble(password: string, name: string): string | null {
	const length = [...password].length;
	if (length < SHORTEST) return `The password has ${length} characters; it needs at least ${SHORTEST}.`;
	if (length > LONGEST) return `The password has ${length} characters; at most ${LONGEST} are kept.`;
	const own = folded(name);
	if (own !== '' && folded(password).includes(own)) return 'The password contains the name.';
	if (new Set(password).size === 1) return 'The password is one character over and over.';
	return null;
}

/** Without regard to case, width and blanks around. */
function folded(text: string): string {
	return text.normalize('NFKC').toLowerCase().trim();
}
