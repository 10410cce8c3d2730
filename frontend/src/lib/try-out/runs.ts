/** What ran when, as lanes over time, and the values at any moment, of a draft that is tried. */
import type { Tried, TriedModel, TriedMoment, Value } from '#lib/contract.ts';

/** A model that was tried, from its place among the moments on: the draft was edited on the way. */
export interface Chapter {
	readonly index: number;
	readonly seconds: number;
	readonly number: number;
	readonly model: TriedModel;
}

/** A run of an ability, in seconds after the beginning. */
export interface Run {
	readonly ability: string;
	readonly from: number;
	readonly to: number;
	readonly is: 'past' | 'running' | 'planned';
}

export interface Lane {
	readonly resource: string;
	readonly runs: readonly Run[];
}

/** The values after `index` moments, with those of the model that was tried then. */
export function valuesAfter(chapters: readonly Chapter[], moments: readonly TriedMoment[], index: number): Record<string, Value | null> {
	const chapter = chapters.findLast((each) => each.index <= index);
	const values: Record<string, Value | null> = { ...chapter?.model.before };
	for (const moment of moments.slice(chapter?.index ?? 0, index)) for (const { name, after } of moment.changes) values[name] = after;
	return values;
}

/** How many of the moments have been by a time. */
export function countAt(moments: readonly TriedMoment[], seconds: number): number {
	return moments.findLastIndex((each) => each.seconds <= seconds) + 1;
}

/** The lanes of all that ran until `now`, what runs then, and what is planned from there. */
export function lanesOf(chapters: readonly Chapter[], moments: readonly TriedMoment[], now: number, plan: Tried['plan']): Lane[] {
	const lanes = new Map<string, Run[]>();
	const open = new Map<string, number>((chapters[0]?.model.running ?? []).map((ability) => [ability, chapters[0]?.seconds ?? 0]));
	const ofAbility = Object.assign({}, ...chapters.map(({ model }) => model.abilities)) as Record<string, string>;
	const put = (run: Run): void => {
		const resource = ofAbility[run.ability] ?? run.ability;
		lanes.set(resource, [...(lanes.get(resource) ?? []), run]);
	};
	for (const { seconds, started, ended, running } of moments) {
		for (const ability of ended)
			if (open.has(ability)) {
				put({ ability, from: open.get(ability) ?? seconds, to: seconds, is: 'past' });
				open.delete(ability);
			}
		for (const ability of started)
			if (running.includes(ability)) open.set(ability, seconds);
			else put({ ability, from: seconds, to: seconds, is: 'past' });
	}
	for (const [ability, from] of open) put({ ability, from, to: now, is: 'running' });
	for (const { ability, start, end } of plan) put({ ability, from: Math.max(start, now), to: Math.max(end, now), is: 'planned' });
	const order = Object.keys(chapters.at(-1)?.model.resources ?? {});
	return [...lanes].map(([resource, runs]) => ({ resource, runs })).sort((one, other) => order.indexOf(one.resource) - order.indexOf(other.resource));
}
