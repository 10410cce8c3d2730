/** How the state of execution is said. */
import type { Mode, PackML, Plan, StationView } from '#lib/contract.ts';

export const MODES: Record<Mode, string> = {
	automatic: 'Automatic',
	paused: 'Paused',
	hold: 'Hold',
	restart: 'Restart'
};

/** What a mode means for what happens next, once production is started. */
const MEANING: Record<Mode, string> = {
	automatic: 'Operations are carried out.',
	paused: 'What runs may finish; nothing is started.',
	hold: 'Nothing is started, and what ran was called off where that is possible.',
	restart: 'Operations wait. Nothing is started but what a person has looked at and taken.'
};

/** What happens next, and what does not. */
export function modeMeaning({ mode, production }: Pick<StationView, 'mode' | 'production'>): string {
	if (production === 'started') return MEANING[mode];
	const nothing = 'Nothing is sent to the devices until production is started.';
	return mode === 'automatic' ? nothing : `${MEANING[mode]} ${nothing}`;
}

/** The states of PackML by the names that the standard has for them. */
export const PACKML: Record<PackML, string> = {
	resetting: 'Resetting',
	idle: 'Idle',
	execute: 'Execute',
	suspended: 'Suspended',
	holding: 'Holding',
	held: 'Held',
	stopping: 'Stopping',
	stopped: 'Stopped',
	aborted: 'Aborted',
	clearing: 'Clearing'
};

export const PRODUCTION: Record<StationView['production'], string> = {
	preparing: 'preparing: nothing moves yet',
	waiting: 'waits for the start of production',
	started: 'production started'
};

export const PLAN_STATUS: Record<Plan['status'], string> = {
	idle: 'Nothing to plan',
	planning: 'Planning',
	followed: 'Followed',
	broken: 'The station departed from the plan; a new one is being looked for',
	none: 'No plan was found'
};

/** `3 starts`, `1 start`. */
export function count(n: number, one: string, many = `${one}s`): string {
	return `${n} ${n === 1 ? one : many}`;
}

/** What the plan promises: what kind it is, its length, how much of it is ahead, and whether less would do. */
export function planLength(plan: Plan): string {
	if (plan.contract === null) return '';
	const ahead = count(plan.steps.filter((step) => step.started === null).length, 'start');
	if (plan.contract === 'minimal') return `Shortest plan, proven: ${count(plan.ticks, 'tick')}, ${ahead} ahead`;
	const ticks = `${count(plan.ticks, 'tick')} (${plan.minimal_ticks ? 'fewest possible' : 'maybe not the fewest'})`;
	return `Plan found soon: ${ticks}, ${ahead} ahead`;
}

/** How the answer came about: `answered in 12 ms by pdr`. */
export function planOrigin(plan: Plan): string {
	if (plan.milliseconds === null) return '';
	return `answered in ${plannerTime(plan.milliseconds)}${plan.engine === '' ? '' : ` by ${plan.engine}`}`;
}

/** Milliseconds the planner took: `0.4 ms`, `12 ms`, `1.2 s`. */
export function plannerTime(milliseconds: number): string {
	if (milliseconds < 10) return `${milliseconds.toFixed(1)} ms`;
	if (milliseconds < 1000) return `${Math.round(milliseconds)} ms`;
	return `${(milliseconds / 1000).toFixed(1)} s`;
}
