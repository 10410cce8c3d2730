/** The station's pages say more than the front: they bring the rest of the catalogue with them. */
import { en } from '#lib/text/en.ts';
import { furnish } from '#lib/text/text.svelte.ts';

export function load(): Promise<void> {
	return furnish({ en: () => en, sv: async () => (await import('#lib/text/sv.ts')).sv });
}
