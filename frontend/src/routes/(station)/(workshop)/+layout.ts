/** The pages of engineers and of the plant's administration say more than operators read, and bring that with them. */
import { en } from '#lib/text/en.ts';
import { furnish } from '#lib/text/text.svelte.ts';
import type { LayoutLoad } from './$types';

export const load: LayoutLoad = async ({ parent }) => {
	await parent();
	await furnish({ en: () => en, sv: async () => (await import('#lib/text/sv.ts')).sv });
};
