/** The station's pages say more than the front, and bring that with them. */
import { station } from '#lib/text/en-station.ts';
import { furnish, type StationSources } from '#lib/text/text.svelte.ts';

const TEXTS: StationSources = { en: () => station, sv: async () => (await import('#lib/text/sv-station.ts')).station };

export function load(): Promise<void> {
	return furnish(TEXTS);
}
