/** How the status of a step is drawn, whose turn it is, and why it is nobody's. */
import { byUrgency, isOver, type Alarms } from '#lib/alarm/priority.ts';
import type { Alarm, Plan, PlanStep, Priority, StationView, StepStatus } from '#lib/contract.ts';
import { awaitsOrder } from '#lib/task/standing.ts';
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
	if (Object.values(view.operations).some((operation) => operation.active)) return 'planning';
	if (Object.values(view.jobs).some(({ state }) => state === 'paused')) return 'order';
	return awaitsOrder(view) ? 'noOrder' : 'idle';
}

/** The share of what is in sight that lies before the present while something does not go on. */
export const BACK = 0.6;

/** Seconds that can be looked back on at least: as many as the station keeps. */
export const KEPT = 60;

/** When the first of the runs began that do not go on: that come to no end, or of which nothing is heard; null where all go on. */
export function standsSince({ steps }: Pick<Plan, 'steps'>, alarms: Alarms): number | null {
	const began = steps.flatMap((step) => (stoppedBy(step, steps, alarms) !== null || isUnheard(step, alarms) ? (step.started ?? []) : []));
	return began.length === 0 ? null : Math.min(...began);
}

/** The shortest of these stretches of time in which what began `age` seconds ago, and a little before it, is in sight; 0, which is all, where none is long enough. */
export function spanFor(age: number, spans: readonly number[]): number {
	return spans.find((span) => span * BACK >= age + 3 && span * BACK <= KEPT) ?? 0;
}

/** The people that a plan waits for: nothing else runs, and their tasks take longer than expected. */
export function awaited({ plan, abilities }: Pick<StationView, 'plan' | 'abilities'>, now: number): string[] {
	const running = plan.steps.filter(({ status }) => status === 'running');
	const late = running.filter(({ ability, expected_end: end }) => abilities[ability]?.human === true && end !== null && end < now);
	return late.length < running.length ? [] : [...new Set(late.map(({ resource }) => resource))];
}

/** Kinds of alarms that tell that a device does not do what it should. */
export const STUCK: ReadonlySet<string> = new Set(['overdue', 'still', 'given-up']);
/** Kinds of alarms that tell that nothing is heard of one, or of several. */
const UNHEARD: ReadonlySet<string> = new Set(['silent', 'many-silent', 'never-heard']);

/** Messages that tell that there is no plan: as a cause of an alarm, and as what an alarm means. */
const NO_PLAN: ReadonlySet<string> = new Set(['no-plan.text', 'wait.no-plan']);

/** Whether an alarm tells that there is no plan: by itself, as what it means, or among what comes of its cause. */
export function isOfNoPlan({ kind, messages: { consequence, parts } }: Alarm): boolean {
	return kind === 'no-plan' || [consequence, ...parts].some(tellsNoPlan);
}

function tellsNoPlan(said: unknown): boolean {
	if (typeof said !== 'object' || said === null || !('id' in said) || !('arguments' in said)) return false;
	return NO_PLAN.has(String(said.id)) || Object.values(said.arguments ?? {}).some(tellsNoPlan);
}

/** The most urgent alarm that lasts about the devices of a resource. */
export function failing(resource: string, alarms: Alarms): Alarm | undefined {
	return byUrgency(alarms).find(([, alarm]) => alarm.group === 'device' && !isOver(alarm) && alarm.resources.includes(resource))?.[1];
}

/** Whether nothing is heard of the device that carries it out: how far it is nobody knows. */
export function isUnheard({ status, resource }: PlanStep, alarms: Alarms): boolean {
	const tells = (alarm: Alarm): boolean => UNHEARD.has(alarm.kind) && !isOver(alarm) && alarm.resources.includes(resource);
	return status === 'running' && Object.values(alarms).some(tells);
}

/** How urgent it is that a run does not come to its end. */
export function stoppedBy(step: PlanStep, steps: readonly PlanStep[], alarms: Alarms): Priority | null {
	return stopOf(step, steps, alarms)?.priority ?? null;
}

/** Since when runs do not come to their end; null where all do. */
export function stoppedSince({ steps }: Pick<Plan, 'steps'>, alarms: Alarms): number | null {
	const since = steps.flatMap((step) => stopOf(step, steps, alarms)?.since ?? []);
	return since.length === 0 ? null : Math.min(...since);
}

/**
 * The alarm that tells of a run that it does not come to its end since then: of this ability, or of its resource, of which the
 * last one is meant.
 */
function stopOf({ ability, started, ended, resource }: PlanStep, steps: readonly PlanStep[], alarms: Alarms): Alarm | null {
	if (started === null) return null;
	/** One that was over before it came is none of those that it tells of. */
	const isMeant = ({ since }: Alarm): boolean => since >= started && (ended === null || ended >= since);
	const own = alarms[`overdue:${ability}`];
	if (own !== undefined && !isOver(own) && isMeant(own)) return own;
	if (steps.some((other) => other.resource === resource && (other.started ?? -Infinity) > started)) return null;
	const alarm = failing(resource, alarms);
	return alarm !== undefined && STUCK.has(alarm.kind) && isMeant(alarm) ? alarm : null;
}
