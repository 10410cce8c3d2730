/** What fields and parts of a model are for, in the language of the page; their schemas say it in English. */
import { language } from '#lib/text/text.svelte.ts';

let swedish = $state.raw<Readonly<Record<string, string>> | null>(null);
let reading: Promise<void> | null = null;

/** Reads the sentences in the language of the page, once, where they are others than those of the schemas. */
export function readHelp(): void {
	if (language() === 'en' || reading !== null) return;
	reading = import('#lib/text/sv/fields.json').then(
		(read) => void (swedish = read.default),
		() => void (reading = null) // until then they are told in English
	);
}

/** A sentence of the schemas in the language of the page. */
export function helpIn(text: string): string {
	return language() === 'sv' ? (swedish?.[text] ?? text) : text;
}
