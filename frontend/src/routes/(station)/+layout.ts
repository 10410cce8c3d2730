/** The station's pages say more than the front, and bring that with them. */
import { station } from '#lib/text/en-station.ts';
import { furnish } from '#lib/text/text.svelte.ts';

export function load(): Promise<void> {
	return furnish({ en: () => station, sv: async () => (await import('#lib/text/sv-station.ts')).station });
}
