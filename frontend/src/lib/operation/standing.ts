/** How far operations are. */
import type { Operation, Plan, PlanStep, Priority, StationView } from '#lib/contract.ts';
import { byUrgency, isOver } from '#lib/alarm/priority.ts';
import { isOfNoPlan, isUnheard, stoppedBy } from '#lib/plan/status.ts';
import { askedFor } from './asked.ts';

/** Done in this round, under way, under way without going on (a step came to no end, or is not heard, or there is no plan), or not begun. */
export type OperationStanding = 'done' | 'active' | 'stopped' | 'waits';

/** How each operation stands, by name. */
export function standingsOf(view: StationView): Map<string, OperationStanding> {
	const began = roundOf(view.operations);
	const stopped = view.plan.steps.filter((step) => stoppedBy(step, view.plan.steps, view.alarms) !== null || isUnheard(step, view.alarms));
	/** Without a plan nothing begins: only what runs still, at devices that are heard, goes on. */
	const planless = view.plan.status === 'none';
	const running = view.plan.steps.filter(({ status }) => status === 'running');
	/** Whatever runs has come to no end: what it is for stands still, also where a newer plan has other steps for that. */
	const stands = running.length > 0 && running.every((step) => stopped.includes(step));
	const free = view.by_order && Object.keys(view.jobs).length === 0;
	return new Map(
		Object.entries(view.operations).map(([name, operation]) => {
			// What is active before production is started is begun by nobody.
			if (operation.active && view.production !== 'started') return [name, 'waits'];
			// In other modes nothing more is started for it.
			if (operation.active && view.mode !== 'automatic' && !isAtWork(operation)) return [name, 'waits'];
			if (operation.active) {
				const own = stepsOf(view.plan, operation);
				const isStopped = own.some((step) => stopped.includes(step)) || (stands && isAtWork(operation));
				const goesOn = own.some((step) => running.includes(step) && !stopped.includes(step));
				return [name, isStopped || (planless && !goesOn) ? 'stopped' : 'active'];
			}
			const asked = askedFor(view, name)?.how;
			if (asked === 'done' || asked === 'skipped') return [name, 'done'];
			// By order a round is that of a job: without one what was made before is no progress.
			const done = !free && asked !== 'later' && asked !== 'now' && asked !== 'paused' && operation.ended !== null && operation.ended >= began;
			return [name, done ? 'done' : 'waits'];
		})
	);
}

/** How urgent it is that steps came to no end: the most urgent alarm that says so; null where all go on. */
export function stoppedTone({ plan, alarms }: StationView): Priority | null {
	const all = plan.steps.map((step) => stoppedBy(step, plan.steps, alarms));
	return (['high', 'medium', 'low'] as const).find((priority) => all.includes(priority)) ?? null;
}

/** How urgent it is that operations do not go on: also that a device is not heard, or that there is no plan; null without an alarm of that. */
export function standstillTone(view: StationView): Priority | null {
	const about = byUrgency(view.alarms).find(([, alarm]) => !isOver(alarm) && (alarm.group === 'device' || isOfNoPlan(alarm)));
	return stoppedTone(view) ?? about?.[1].priority ?? null;
}

/** The operations that have stopped by their names, and how urgent that is. */
export interface Stopped {
	readonly priority: Priority;
	readonly operations: ReadonlySet<string>;
}

/** Null where all go on. */
export function stoppedOf(view: StationView): Stopped | null {
	const priority = stoppedTone(view);
	if (priority === null) return null;
	const operations = [...standingsOf(view)].flatMap(([name, standing]) => (standing === 'stopped' ? [name] : []));
	return { priority, operations: new Set(operations) };
}

/**
 * The operations that are shown as under way: of several that differ in a parameter alone those at which somebody is at work, or else
 * the first.
 */
export function underWay(view: StationView): ReadonlySet<string> {
	const groups = new Map<string, string[]>();
	for (const [name, standing] of standingsOf(view)) {
		if (standing !== 'active' && standing !== 'stopped') continue;
		const group = name.split('(')[0] ?? name;
		groups.set(group, [...(groups.get(group) ?? []), name]);
	}
	return new Set(
		[...groups.values()].flatMap((names) => {
			const worked = names.filter((name) => isAtWork(view.operations[name] ?? { active: false, work: [] }));
			return worked.length > 0 ? worked : names.slice(0, 1);
		})
	);
}

/** Whether somebody is at work for an active operation now: a step that serves it runs. */
export function isAtWork({ active, work }: Pick<Operation, 'active' | 'work'>): boolean {
	return active && work.at(-1)?.ended === null;
}

/** How many seconds it took the last time; null where that was never. */
export function tookOf({ began, ended }: Operation): number | null {
	return began === null || ended === null ? null : ended - began;
}

/** What the plan does for an operation. */
export function stepsOf({ steps }: Plan, operation: Operation): PlanStep[] {
	return steps.filter(({ id }) => operation.steps.includes(id));
}

/** When this round began: a round begins with the first operation of the model. */
function roundOf(operations: Readonly<Record<string, Operation>>): number {
	const [first] = Object.values(operations);
	return first?.active_since ?? first?.began ?? -Infinity;
}
