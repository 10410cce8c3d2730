/** What a simulation has found, as lanes over time: one for each resource that does something, and one for operations. */
import type { WhatIf } from '#lib/contract.ts';
import type { Lane } from '#lib/history/lanes.ts';

/** The lanes of a simulation; `resource` says what people call one, `operations` what the last lane is called. */
export function lanesOf(found: WhatIf, resource: (name: string) => string, operations: string): Lane[] {
	const names = [...new Set(found.runs.map((run) => run.resource))];
	const lanes = names.map(
		(name): Lane => ({
			id: name,
			title: resource(name),
			bars: found.runs
				.filter((run) => run.resource === name)
				.map((run) => ({
					from: run.started,
					to: run.ended ?? found.seconds,
					label: run.title,
					number: null,
					open: run.ended === null
				})),
			spots: []
		})
	);
	const spots = found.completed.map(({ title, at }) => ({ time: at, label: title, number: null, act: null, refused: false }));
	return spots.length === 0 ? lanes : [...lanes, { id: 'operations', title: operations, bars: [], spots }];
}

/** A change of a variable from the beginning to the end. */
export interface Change {
	readonly name: string;
	readonly before: WhatIf['before'][string] | undefined;
	readonly after: WhatIf['after'][string] | undefined;
}

/** The variables that are otherwise at the end, by name. */
export function changesOf({ before, after }: Pick<WhatIf, 'before' | 'after'>): Change[] {
	return Object.keys(after)
		.filter((name) => before[name] !== after[name])
		.sort()
		.map((name) => ({ name, before: before[name], after: after[name] }));
}
