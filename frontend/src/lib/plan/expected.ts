/** When steps begin and how long they take, as a table says it, in whole seconds. */
import type { Plan, PlanStep } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { agoText, durationText } from '#lib/wording/time.ts';
import { plannerTime } from '#lib/wording/station.ts';
import { hasBegun, lateness, timesOf } from './lanes.ts';

type Texts = Text['operate']['plan'];

/** When it began, or is expected to: `12 s ago`, `in 4 s`. */
export function beginText(step: PlanStep, now: number, late: number, live: boolean, texts: Texts): string {
	const { start } = timesOf(step, now, late);
	return hasBegun(step) ? agoText(-start, live) : texts.inSeconds(Math.round(start));
}

/** How long it has taken, and how long it is expected to: `0:12`, `about 3 s`. */
export function lengthText(step: PlanStep, now: number, late: number, texts: Texts): string {
	const { start, end } = timesOf(step, now, late);
	if (!hasBegun(step)) return texts.about(Math.round(end - start));
	const lasted = durationText((step.ended ?? now) - step.started);
	const expected = Math.round((step.expected_end ?? step.started) - step.started);
	return step.ended === null && expected > 0 ? `${lasted}, ${texts.about(expected)}` : lasted;
}

/** In how many seconds the last step is expected to end; null where nothing is left. */
export function leftOf(steps: readonly PlanStep[], now: number): number | null {
	const late = lateness(steps, now);
	const left = steps.filter((step) => step.status !== 'done').map((step) => timesOf(step, now, late).end);
	return left.length === 0 ? null : Math.round(Math.max(0, ...left));
}

/** What the plan promises, and how the answer came about. */
export function promiseText(plan: Plan, now: number, texts: Texts): string {
	const ahead = plan.steps.filter((step) => !hasBegun(step)).length;
	const left = leftOf(plan.steps, now);
	const { contract, milliseconds, engine } = plan;
	const parts = [
		contract === null ? '' : contract === 'minimal' ? texts.shortest(ahead) : texts.soon(plan.minimal_ticks, ahead),
		left === null ? '' : texts.ends(left),
		milliseconds === null
			? ''
			: engine === ''
				? texts.answered(plannerTime(milliseconds))
				: texts.answeredBy(plannerTime(milliseconds), engine)
	];
	return parts.filter((part) => part !== '').join(' ');
}
