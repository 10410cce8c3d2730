/** A plan that nobody follows yet, as lanes: a row for each resource, a column for each tick in which something starts. */
import type { PlanPreview } from '#lib/contract.ts';

type Step = PlanPreview['steps'][number];

export interface Grid {
	readonly ticks: readonly number[];
	readonly lanes: readonly { readonly resource: string; readonly cells: readonly (readonly Step[])[] }[];
}

export function gridOf({ steps }: PlanPreview): Grid {
	const ticks = [...new Set(steps.map((step) => step.tick))].sort((a, b) => a - b);
	const resources = [...new Set(steps.map((step) => step.resource))];
	const lanes = resources.map((resource) => {
		const own = steps.filter((step) => step.resource === resource);
		return { resource, cells: ticks.map((tick) => own.filter((step) => step.tick === tick)) };
	});
	return { ticks, lanes };
}
