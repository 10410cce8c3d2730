/**
 * What the pages say, in the language that was chosen.
 *
 * `say()` has all texts; whoever reads it in a template or a derivation gets the others as soon as the language changes.
 * English is the catalogue that the others are typed by: a text that one of them lacks is a type error. The titles of the
 * model and the sentences of the controller come from the station, in each language that there is.
 *
 * The watch and the pages before the sign-in read only the rooms of the *front* catalogue; the station's pages `furnish`
 * those of operators, and the pages of engineers and of the plant's administration all the others. That no page says more
 * than is there is a test.
 */
import { front } from './en-front.ts';
import type { station } from './en-station.ts';
import type { en } from './en.ts';
import { keepLanguage, keptLanguage, type Language } from './languages.ts';

type Said<T> = T extends string
	? string
	: T extends (...given: infer Given) => string
		? (...given: Given) => string
		: { readonly [Key in keyof T]: Said<T[Key]> };

export type Text = Said<typeof en>;
export type OfStation = Said<typeof station>;
export type Front = Said<typeof front>;

/** Where the texts of each language are read from. */
export type Sources = Readonly<Record<Language, () => Front | Promise<Front>>>;

/** What the server says of what it refused, which English needs not as a refusal says itself in it what it says. */
const REFUSALS: Readonly<Record<Exclude<Language, 'en'>, () => Promise<{ default: Front['messages'] }>>> = {
	sv: () => import('./sv/front.json')
};

let sources: Sources = { en: () => front, sv: async () => (await import('./sv-front.ts')).front };
const furnished = new Set<Sources>();
let texts = $state.raw<Front>(front);
let chosen = $state<Language>('en');
/** Numbers what was asked to be shown, so that texts that were overtaken are not shown. */
let asked = 0;

/** All texts in the language of the page. */
export function say(): Text {
	return texts as Text;
}

/** The language of the page. */
export function language(): Language {
	return chosen;
}

/** A text of the model in a language: that one, else English, else what there is. */
export function inLanguage(text: Readonly<Record<string, string>>, language: string): string {
	return text[language] ?? text['en'] ?? text[''] ?? Object.values(text)[0] ?? '';
}

/** Shows the pages in `wanted`, which is read from the server where it is not English. */
async function show(wanted: Language): Promise<void> {
	const number = ++asked;
	const found = await sources[wanted]();
	if (number !== asked) return;
	texts = found;
	chosen = wanted;
	document.documentElement.lang = wanted;
}

/** Shows the pages in the language that was kept. Where it cannot be read they stay in English. */
export async function showKept(): Promise<void> {
	const number = asked + 1;
	await show(keptLanguage()).catch(() => (number === asked ? show('en') : undefined));
}

/** Where texts with the rooms of a station's pages are read from. */
export type StationSources = Readonly<Record<Language, () => OfStation | Promise<OfStation>>>;

/**
 * From now on the rooms of `more` are there. Said once more, it changes nothing: where all of a page is loaded again, as by
 * a link to the page itself, the station's texts would otherwise take the place of the engineers' while their page is shown.
 */
export async function furnish(more: StationSources): Promise<void> {
	if (furnished.has(more)) return;
	furnished.add(more);
	sources = more;
	await showKept();
}

/**
 * What tells a refusal is there from now on: the watch and the pages before the sign-in read it when something is first refused,
 * as most never are. Where it cannot be read a refusal is told in English.
 */
export async function readRefusals(): Promise<void> {
	if (chosen === 'en' || Object.keys(texts.messages).length > 0) return;
	const number = asked;
	const found = await REFUSALS[chosen]().catch(() => null);
	if (found !== null && number === asked) texts = { ...texts, messages: found.default };
}

/** Shows the pages in `wanted`, from now on. */
export async function choose(wanted: Language): Promise<void> {
	await show(wanted);
	keepLanguage(wanted);
}
