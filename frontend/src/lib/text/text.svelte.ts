/**
 * What the pages say, in the language that was chosen.
 *
 * `say()` has all texts; whoever reads it in a template or a derivation gets the others as soon as the language changes.
 * English is the catalogue that the others are typed by: a text that one of them lacks is a type error. What comes from
 * the station (titles of the model, sentences of the controller) is shown as it comes.
 */
import { en } from './en.ts';
import { keepLanguage, keptLanguage, type Language } from './languages.ts';

type Said<T> = T extends string
	? string
	: T extends (...given: infer Given) => string
		? (...given: Given) => string
		: { readonly [Key in keyof T]: Said<T[Key]> };

export type Text = Said<typeof en>;

let texts = $state.raw<Text>(en);
let chosen = $state<Language>('en');

/** All texts in the language of the page. */
export function say(): Text {
	return texts;
}

/** The language of the page. */
export function language(): Language {
	return chosen;
}

/** Shows the pages in `wanted`, which is read from the server where it is not English. */
async function show(wanted: Language): Promise<void> {
	texts = wanted === 'sv' ? (await import('./sv.ts')).sv : en;
	chosen = wanted;
	document.documentElement.lang = wanted;
}

/** Shows the pages in the language that was kept. Where it cannot be read they stay in English. */
export async function showKept(): Promise<void> {
	const kept = keptLanguage();
	if (kept !== 'en') await show(kept).catch(() => undefined);
}

/** Shows the pages in `wanted`, from now on. */
export async function choose(wanted: Language): Promise<void> {
	await show(wanted);
	keepLanguage(wanted);
}
