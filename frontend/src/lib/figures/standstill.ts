/** Whether the station goes on with what is in work, as the server looks at it when it says when that will be ready. */
import type { PlanStep, StationView } from '#lib/contract.ts';
import { isUnheard, stoppedBy } from '#lib/plan/status.ts';

/** `stopped`: something does not do what it should, or there is no plan. `waits`: for a person, or for the mode. */
export type Standstill = 'stopped' | 'waits';

/** Seconds that a person may take longer than expected, and as long again as expected. */
const PATIENCE = 10;

/** Null while something goes on, and while nothing is to. */
export function standstillOf(view: StationView | null, now: number): Standstill | null {
	if (view === null || view.production !== 'started') return null;
	if (view.mode !== 'automatic') return 'waits';
	if (view.standing === 'stopped') return 'stopped';
	const { plan, alarms, abilities } = view;
	const running = plan.steps.filter(({ status }) => status === 'running');
	if (running.length === 0) return plan.status === 'none' && Object.values(view.operations).some(({ active }) => active) ? 'stopped' : null;
	const isLate = ({ ability, started, expected_end: end }: PlanStep): boolean =>
		abilities[ability]?.human === true && started !== null && end !== null && now > end + Math.max(PATIENCE, end - started);
	const stopped = running.filter((step) => stoppedBy(step, plan.steps, alarms) !== null || isUnheard(step, alarms));
	if (running.some((step) => !stopped.includes(step) && !isLate(step))) return null;
	return stopped.length > 0 ? 'stopped' : 'waits';
}
