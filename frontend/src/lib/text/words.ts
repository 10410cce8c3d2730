/** What a model says in its own words. */

/** A text in a language: that one, else English, else what there is. */
export function inLanguage(text: Readonly<Record<string, string>>, language: string): string {
	return text[language] ?? text['en'] ?? text[''] ?? Object.values(text)[0] ?? '';
}
