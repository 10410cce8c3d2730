/** What is said to whoever asks what one does on a page, and where it is read from: only when asked for. */
import type { Language } from '#lib/text/languages.ts';
import type { Text } from '#lib/text/text.svelte.ts';

/** The watch has no room for help. */
export type HelpedPage = Exclude<keyof Text['pages'], 'watch'>;

export interface Help {
	/** What the page is for, in a sentence. */
	readonly about: string;
	/** What one does here, a line each; the first ones have their number in the picture. */
	readonly how: readonly string[];
}

export interface Helped {
	readonly title: (page: string) => string;
	/** What is pressed, and what it does. */
	readonly keys: {
		readonly title: string;
		readonly all: readonly (readonly [pressed: string, does: string])[];
		/** Only where conditions are written. */
		readonly conditions: readonly (readonly [pressed: string, does: string])[];
	};
	readonly pages: Readonly<Record<HelpedPage, Help>>;
}

export const HELPED: Readonly<Record<Language, () => Promise<Helped>>> = {
	en: async () => (await import('#lib/text/en/help.ts')).help,
	sv: async () => (await import('#lib/text/sv/help.ts')).help
};
