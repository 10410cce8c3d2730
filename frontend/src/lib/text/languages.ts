/** The languages of the pages, and which of them a person gets who has not chosen. */
export const LANGUAGES = { en: 'English', sv: 'Svenska' } as const;
export type Language = keyof typeof LANGUAGES;

const KEY = 'language';

function isLanguage(word: string | null | undefined): word is Language {
	return word !== null && word !== undefined && Object.hasOwn(LANGUAGES, word);
}

/** The first of `wanted` (BCP 47, as a browser gives them) that there is; English where there is none. */
export function bestOf(wanted: readonly string[]): Language {
	return wanted.map((tag) => tag.split('-')[0]?.toLowerCase()).find(isLanguage) ?? 'en';
}

/** The language that was chosen in this browser, else the one that its owner reads. */
export function keptLanguage(): Language {
	let kept: string | null = null;
	try {
		kept = localStorage.getItem(KEY);
	} catch {
		// Storage may be forbidden; then the browser's own languages decide.
	}
	return isLanguage(kept) ? kept : bestOf(navigator.languages);
}

/** Keeps the choice. */
export function keepLanguage(language: Language): void {
	try {
		localStorage.setItem(KEY, language);
	} catch {
		// It lasts as long as the page then.
	}
}
