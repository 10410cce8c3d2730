/** Who somebody is where there is room for two letters. */

/** The first letters of the first and the last word of a name: `EL` of `Eva Lind`; a question mark of none. */
export function initialsOf(name: string): string {
	const words = name.trim().split(/\s+/).filter(Boolean);
	const letters = [words[0], ...(words.length > 1 ? [words.at(-1)] : [])].map((word) => [...(word ?? '')][0] ?? '');
	return letters.join('').toLocaleUpperCase() || '?';
}
