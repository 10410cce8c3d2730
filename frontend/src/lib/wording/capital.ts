/** Words as they begin a sentence or a heading; what is no letter stays as it is. */
export function capital(words: string): string {
	return words.charAt(0).toLocaleUpperCase() + words.slice(1);
}
