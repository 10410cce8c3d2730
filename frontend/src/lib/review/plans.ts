/** How the station would go on with two models, as lanes: what runs with the one above what runs with the other. */
import type { WhatIf } from '#lib/contract.ts';

export interface Bar {
	readonly ability: string;
	readonly title: string;
	readonly from: number;
	readonly to: number;
	readonly open: boolean;
}

export interface Pair {
	readonly resource: string;
	readonly before: readonly Bar[];
	readonly after: readonly Bar[];
	readonly differs: boolean;
}

/** An operation that is completed at another time, or with one of them only. */
export interface Completion {
	readonly title: string;
	readonly before: number | null;
	readonly after: number | null;
}

/** Seconds by which two moments may differ without being told apart: a simulation goes in ticks. */
const ALIKE = 0.3;
/** Seconds by which an operation is earlier or later, so that it is worth a sentence. */
const TOLD = 1;

/** A pair of lanes for each resource that does something, those first in which something differs. */
export function pairsOf(before: WhatIf, after: WhatIf): Pair[] {
	const names = [...new Set([...before.runs, ...after.runs].map(({ resource }) => resource))];
	const pairs = names.map((resource): Pair => {
		const both = [barsOf(before, resource), barsOf(after, resource)] as const;
		return { resource, before: both[0], after: both[1], differs: !areAlike(...both) };
	});
	const first = ({ before, after, differs }: Pair): number => (differs ? firstDifference(before, after) : Infinity);
	return pairs.toSorted((one, other) => first(one) - first(other) || 0);
}

function barsOf({ runs, seconds }: WhatIf, resource: string): Bar[] {
	return runs
		.filter((run) => run.resource === resource)
		.map(({ ability, title, started, ended }) => ({ ability, title, from: started, to: ended ?? seconds, open: ended === null }));
}

function isAlike(one: Bar | undefined, other: Bar | undefined): boolean {
	if (one === undefined || other === undefined) return one === other;
	return one.ability === other.ability && one.open === other.open && Math.abs(one.from - other.from) < ALIKE && Math.abs(one.to - other.to) < ALIKE;
}

function areAlike(one: readonly Bar[], other: readonly Bar[]): boolean {
	return one.length === other.length && one.every((bar, place) => isAlike(bar, other[place]));
}

/** When the first of what differs begins or ends. */
function firstDifference(one: readonly Bar[], other: readonly Bar[]): number {
	const place = Array.from({ length: Math.max(one.length, other.length) }, (_, index) => index).find((index) => !isAlike(one[index], other[index])) ?? 0;
	const bars = [one[place], other[place]].filter((bar) => bar !== undefined);
	const [first, second] = bars;
	if (first !== undefined && second !== undefined && first.ability === second.ability && Math.abs(first.from - second.from) < ALIKE) return Math.min(first.to, second.to);
	return Math.min(...bars.map(({ from }) => from));
}

/** The operations that are completed at other times, each the first time, in their order. */
export function completionsOf(before: WhatIf, after: WhatIf): Completion[] {
	const firsts = ({ completed }: WhatIf): Map<string, { title: string; at: number }> => {
		const found = new Map<string, { title: string; at: number }>();
		for (const { operation, title, at } of completed) if (!found.has(operation)) found.set(operation, { title, at });
		return found;
	};
	const [one, other] = [firsts(before), firsts(after)];
	return [...new Set([...one.keys(), ...other.keys()])].flatMap((name) => {
		const [was, is] = [one.get(name), other.get(name)];
		if (was !== undefined && is !== undefined && Math.abs(was.at - is.at) < TOLD) return [];
		return [{ title: was?.title ?? is?.title ?? name, before: was?.at ?? null, after: is?.at ?? null }];
	});
}
