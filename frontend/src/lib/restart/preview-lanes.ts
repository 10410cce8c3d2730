/** A plan that nobody follows yet as the lanes of a plan draw it. */
import type { PlanPreview, PlanStep } from '#lib/contract.ts';

/** When the last of it is over; a second where nothing takes time. */
export function lengthOf({ steps }: Pick<PlanPreview, 'steps'>): number {
	return Math.max(1, ...steps.map(({ end }) => end));
}

/** Its starts as steps, whose times are seconds after the present. The first is next. */
export function stepsOf({ steps }: Pick<PlanPreview, 'steps'>): PlanStep[] {
	return steps.map(({ ability, title, resource, tick, start, end }, number) => ({
		id: String(number),
		ability,
		title,
		resource,
		tick,
		status: number === 0 ? 'next' : 'planned',
		started: null,
		ended: null,
		expected_start: start,
		expected_end: end,
		after: null,
		new: false,
		waits_for: [],
		waits_for_messages: [],
		sentence: null
	}));
}
