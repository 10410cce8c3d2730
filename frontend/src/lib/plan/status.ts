/** How the status of a step is drawn, whose turn it is, and why it is nobody's. */
import type { Plan, PlanStep, StationView, StepStatus } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';

/** A shape for each status, so that none has to be told by colour. */
export const MARK: Record<StepStatus, string> = { done: '✓', running: '▶', next: '➜', planned: '○' };

/** The steps whose turn it is, in the order in which they may start. */
export function nextSteps(plan: Plan): PlanStep[] {
	return plan.steps.filter((step) => step.status === 'next');
}

/** Why there is no next start. */
export function nothingNext(view: StationView): keyof Text['frame']['nothingNext'] {
	const { plan, mode, errand } = view;
	if (view.production !== 'started') return 'production';
	if (plan.status === 'broken' || plan.status === 'none' || plan.status === 'planning') return plan.status;
	if (mode !== 'automatic' && errand === null) return 'paused';
	if (plan.steps.some((step) => step.status === 'running')) return 'waits';
	if (plan.status === 'followed') return 'followed';
	// What is active is planned for as soon as the controller comes to it.
	return Object.values(view.operations).some((operation) => operation.active) ? 'planning' : 'idle';
}
