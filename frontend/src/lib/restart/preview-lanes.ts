/** A plan that nobody follows yet as a picture over time: a lane for each resource, what would overlap in rows. Times are seconds. */
import type { PlanPreview } from '#lib/contract.ts';

type Step = PlanPreview['steps'][number];

export interface PreviewBar {
	readonly step: Step;
	/** Its number in the plan, from 0. */
	readonly number: number;
	/** Where it is drawn, as shares of the whole. */
	readonly from: number;
	readonly to: number;
}

export interface PreviewLane {
	readonly resource: string;
	readonly rows: readonly (readonly PreviewBar[])[];
}

/** The share of the whole that a bar has at least, so that it can be seen. */
export const LEAST = 0.05;

/** When the last of it is over; a second where nothing takes time. */
export function lengthOf({ steps }: Pick<PlanPreview, 'steps'>): number {
	return Math.max(1, ...steps.map(({ end }) => end));
}

export function lanesOf(plan: Pick<PlanPreview, 'steps'>): PreviewLane[] {
	const length = lengthOf(plan);
	const lanes = new Map<string, PreviewBar[][]>();
	for (const [number, step] of plan.steps.entries()) {
		const from = Math.min(step.start / length, 1 - LEAST);
		const bar = { step, number, from, to: Math.min(1, Math.max(step.end / length, from + LEAST)) };
		const rows = lanes.get(step.resource) ?? [];
		lanes.set(step.resource, rows);
		const free = rows.find((row) => (row.at(-1)?.to ?? 0) <= bar.from);
		if (free) free.push(bar);
		else rows.push([bar]);
	}
	return [...lanes].map(([resource, rows]) => ({ resource, rows }));
}
