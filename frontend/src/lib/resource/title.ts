/** Resources as they are chosen from: by what they are called. */
import type { StationView } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** The name and the title of each, in the order of the titles. */
export function resourcesByTitle(resources: StationView['resources']): (readonly [name: string, title: string])[] {
	return Object.entries(resources)
		.map(([name, { title }]) => [name, title] as const)
		.sort(([, a], [, b]) => a.localeCompare(b, say().locale));
}
