/** The station as a document that a picture is drawn of, at a moment of a draft that is tried. */
import type { StationView, Value } from '#lib/contract.ts';
import { titledAlone } from '#lib/wording/titled.svelte.ts';
import type { Chapter } from './runs.ts';

/** What is known of a moment. */
export interface Known {
	readonly values: Readonly<Record<string, Value | null>>;
	readonly running: readonly string[];
	readonly active: readonly string[];
}

/**
 * `view`, with what is so in the simulation instead of what is so at the station, and without alarms and tasks. Resources and
 * variables that the draft has and the station has not are there by what the draft calls them.
 */
export function triedView(view: StationView, chapter: Chapter, { values, running, active }: Known): StationView {
	const runs = new Set(running);
	const pursued = new Set(active);
	const resources = Object.entries(chapter.model.resources).map(([name, title]) => [name, { title: titledAlone(title), online: true, awaited_topics: [] as string[] }] as const);
	return {
		...view,
		production: 'started',
		variables: Object.fromEntries(Object.entries(view.variables).map(([name, one]) => [name, { ...one, value: values[name] ?? null }])),
		abilities: Object.fromEntries(
			Object.entries(view.abilities).map(([name, one]) => [name, { ...one, executing: runs.has(name), enabled: null, running_since: null }])
		),
		operations: Object.fromEntries(Object.entries(view.operations).map(([name, one]) => [name, { ...one, active: pursued.has(name) }])),
		resources: { ...view.resources, ...Object.fromEntries(resources) },
		alarms: {},
		tasks: {}
	};
}
