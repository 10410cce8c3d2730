/** A space after a word, before the index that it has. */
const INDEXED = /(?<=\p{L}) (?=\d+(?![\p{L}\d:.%]))/gu;
/** A space after a number, before its unit. */
const MEASURED = /(?<=\d) (?=(?:s|ms|min|h|%)(?![\p{L}\d]))/gu;

/** Text in which a word and its index stay on one line, and a number and its unit: `pair 5`, `40 s`. */
export function unbroken(text: string): string {
	return text.replace(INDEXED, '\u00a0').replace(MEASURED, '\u00a0');
}
