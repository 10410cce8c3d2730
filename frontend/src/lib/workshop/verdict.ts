/** What a check of the draft comes to. */
import type { ModelCheck } from '#lib/contract.ts';

/**
 * `waiting`, `checking` and `failed` as the check says; of one that is done: `unusable` with errors, `unmeetable` without
 * a supervisor, else `good`, warnings or not.
 */
export type Verdict = 'waiting' | 'checking' | 'failed' | 'unusable' | 'unmeetable' | 'good';

export function verdictOf(check: ModelCheck): Verdict {
	if (check.state !== 'done') return check.state;
	if (check.findings.some(isError)) return 'unusable';
	return check.analysis?.supervised === true ? 'good' : 'unmeetable';
}

export function isError(finding: { readonly severity: string }): boolean {
	return finding.severity === 'error';
}

export interface Counts {
	readonly errors: number;
	readonly warnings: number;
}

export function countsOf(findings: readonly { readonly severity: string }[]): Counts {
	const errors = findings.filter(isError).length;
	return { errors, warnings: findings.length - errors };
}

/** What a check looks for, one after the other, as it calls it itself. */
export const STAGES = ['reading it', 'the examples of pipelines', 'what is suspicious', 'the safe states', 'the findings', 'the guards'] as const;

/** What takes the place of the last stages where there are no safe states. */
const WHY_NONE = 'why they are none';

/** At which of the stages a check is: -1 before the first, their number after the last, null where that is not known. */
export function stageOf(check: Pick<ModelCheck, 'state' | 'doing'>): number | null {
	if (check.state === 'waiting') return -1;
	if (check.state === 'done') return STAGES.length;
	if (check.doing === WHY_NONE) return STAGES.indexOf('the findings');
	const stage = STAGES.findIndex((each) => each === check.doing);
	return stage < 0 ? null : stage;
}

/** Seconds that the check took in all. */
export function secondsOf(check: Pick<ModelCheck, 'looked'>): number {
	return check.looked.reduce((sum, { seconds }) => sum + seconds, 0);
}
