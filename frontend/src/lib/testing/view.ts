/** Documents for tests: a small station, with what a test is about put in. */
import type { Plan, PlanStep, StationView, Task } from '#lib/contract.ts';

export const PLAN: Plan = {
	status: 'followed',
	reason: '',
	steps: [],
	ticks: 0,
	minimal_ticks: true,
	minimal_starts: true,
	replanned: 0,
	contract: 'minimal',
	engine: '',
	milliseconds: null,
	why: null
};

/** A step of a plan; its id is its ability. */
export function step(ability: string, resource: string, tick: number, rest: Partial<PlanStep> = {}): PlanStep {
	const title = ability;
	const base: PlanStep = {
		id: ability,
		ability,
		title,
		resource,
		tick,
		status: 'planned',
		started: null,
		ended: null,
		waits_for: []
	};
	return { ...base, ...rest };
}

export function task(created: number): Task {
	const place = { ability: 'operator.place', resource: 'operator', title: 'Place', text: 'Place it' };
	return { revision: 1, ...place, created, next_moves: [] };
}

export function view(rest: Partial<StationView> = {}): StationView {
	const station = { name: 'station', title: 'Station', description: '', transport: 'dds', emulated: true };
	return {
		station,
		tick: 0,
		time: 1000,
		mode: 'automatic',
		production: 'started',
		resources: {},
		variables: {},
		abilities: {},
		operations: {},
		plan: PLAN,
		tasks: {},
		topics: {},
		overrides: {},
		alarms: {},
		way_back: null,
		control: null,
		analysis: null,
		...rest
	};
}
