/** The pages of engineers and of the plant's administration say more than operators read, and bring that with them. */
import { en } from '#lib/text/en.ts';
import { furnish } from '#lib/text/text.svelte.ts';

/** After the texts of the station, which would otherwise take the place of these. */
export async function load({ parent }: { readonly parent: () => Promise<unknown> }): Promise<void> {
	await parent();
	await furnish({ en: () => en, sv: async () => (await import('#lib/text/sv.ts')).sv });
}
