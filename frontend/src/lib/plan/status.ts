/** How the status of a step is said and drawn: a word and a shape, so that neither has to be told by colour. */
import type { Plan, PlanStep, StepStatus } from '#lib/contract.ts';

export const STATUS: Record<StepStatus, { readonly word: string; readonly mark: string }> = {
	done: { word: 'done', mark: '✓' },
	running: { word: 'running', mark: '▶' },
	next: { word: 'next', mark: '➜' },
	planned: { word: 'planned', mark: '○' }
};

/** The steps whose turn it is, in the order in which they may start. */
export function nextSteps(plan: Plan): PlanStep[] {
	return plan.steps.filter((step) => step.status === 'next');
}

/** What the column ahead that is `turn` columns (from 0) behind the present is called. */
export function turnText(turn: number): string {
	return ['next', 'then'][turn] ?? `${turn + 1}.`;
}
