/** The pages of engineers and of the plant's administration say more than operators read, and bring that with them. */
import { en } from '#lib/text/en.ts';
import { furnish, type StationSources } from '#lib/text/text.svelte.ts';

const TEXTS: StationSources = { en: () => en, sv: async () => (await import('#lib/text/sv.ts')).sv };

/** After the texts of the station, which would otherwise take the place of these. */
export async function load({ parent }: { readonly parent: () => Promise<unknown> }): Promise<void> {
	await parent();
	await furnish(TEXTS);
}
