/** What led here, in a few words. */
import type { LastCorrection, StationView } from '#lib/contract.ts';
import { fullName, valueOf } from '#lib/wording/names.svelte.ts';

/** What was said of the station: `Bolt pair 1: placed`. */
export function correctedText(view: Pick<StationView, 'resources' | 'variables'> | null, { values }: Pick<LastCorrection, 'values'>): string {
	return Object.entries(values)
		.map(([name, value]) => `${fullName(view, name)}: ${valueOf(name, value)}`)
		.join(', ');
}
