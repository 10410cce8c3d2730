/** Documents of the server with the titles of the model in the language of the page, as far as these are known. */
import { language } from '#lib/text/text.svelte.ts';
import { Titles, type PartNames } from './titles.ts';

let names = $state.raw<PartNames | null>(null);
const titles = $derived(new Titles(names, language()));

/** The titles of the model's parts are these from now on. */
export function tellTitles(known: PartNames | null): void {
	names = known;
}

/** The titles as they are known: what is made of a document that is not followed is made again when they are others. */
export function titlesNow(): Titles {
	return titles;
}

/** A title that stands alone in the language of the page. */
export function titledAlone(text: string): string {
	return titles.alone(text);
}

/** A document in the language of the page. Whoever reads it where it is derived gets another one with another language. */
export function titled<Value>(document: Value): Value {
	return titles.in(document);
}
