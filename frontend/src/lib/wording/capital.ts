/** Words as they begin a sentence or a heading; what is no letter stays as it is. */
export function capital(words: string): string {
	return words.charAt(0).toLocaleUpperCase() + words.slice(1);
}

/** A title as it stands within a sentence: `Mutterdragaren` → `mutterdragaren`; `AGV:n` and `UR10` stay as they are. */
export function withinSentence(title: string): string {
	const [first = ''] = title.split(' ', 1);
	const rest = first.slice(1);
	return rest !== rest.toLocaleLowerCase() || /\d/.test(first) ? title : title.charAt(0).toLocaleLowerCase() + title.slice(1);
}
