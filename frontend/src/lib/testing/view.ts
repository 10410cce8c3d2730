/** Documents for tests: a small station, with what a test is about put in. */
import type { Alarm, Operation, Plan, PlanStep, StationView, Task, Variable } from '#lib/contract.ts';

export const PLAN: Plan = {
	status: 'followed',
	since: 0,
	reason: '',
	reason_message: { id: 'as-it-was', arguments: { text: '' } },
	steps: [],
	ticks: 0,
	minimal_ticks: true,
	minimal_starts: true,
	replanned: 0,
	replacement: null,
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
		expected_start: null,
		expected_end: null,
		after: null,
		new: false,
		waits_for: [],
		waits_for_messages: [],
		sentence: null
	};
	return { ...base, ...rest };
}

/** An operation that was never active. */
export function operation(rest: Partial<Operation> = {}): Operation {
	const base: Operation = {
		title: 'Tighten',
		active: false,
		active_since: null,
		completed: 0,
		began: null,
		ended: null,
		first_step: null,
		last_step: null,
		steps: [],
		work: [],
		goal: 'b == tightened',
		precondition: 'b == placed',
		sentence: null,
		left_out: false,
		repeat: true,
		for_jobs: false,
		job: null
	};
	return { ...base, ...rest };
}

export function task(created: number): Task {
	const place = { ability: 'operator.place', resource: 'operator', title: 'Place', text: 'Place it' };
	return { revision: 1, ...place, created, next_moves: [], movers: [], begins: [], problem: null, instruction: null };
}

export function alarm(rest: Partial<Alarm> = {}): Alarm {
	const text = rest.text ?? 'The robot is silent';
	const told = { id: 'as-it-was', arguments: { text } };
	return {
		kind: 'silent',
		subject: 'robot',
		group: 'device',
		priority: 'medium',
		state: 'unacknowledged',
		text,
		consequence: 'Nothing is started with it',
		action: 'Look at it',
		messages: { text: told, consequence: null, action: null, parts: [] },
		resources: ['robot'],
		topics: [],
		since: 990,
		ended: null,
		by: null,
		until: null,
		why: null,
		count: 1,
		parts: [],
		...rest
	};
}

/** An estimated variable. */
export function estimate(rest: Partial<Variable> = {}): Variable {
	return {
		resource: null,
		kind: 'estimated',
		value: 'placed',
		domain: ['empty', 'placed'],
		dual_approval: false,
		since: 900,
		awaits: null,
		last_known: null,
		belief: { writer: 'operator.place', at: 900, evidence: [], unconfirmed_since: null },
		commanded_by: null,
		...rest
	};
}

export function view(rest: Partial<StationView> = {}): StationView {
	const station = { name: 'station', title: 'Station', titles: { '': 'Station' }, description: '', transport: 'dds', emulated: true, deployment_approval: 'single' as const };
	return {
		station,
		tick: 0,
		time: 1000,
		revision: 0,
		mode: 'automatic',
		packml: 'execute',
		standing: 'working',
		silent: [],
		failing: [],
		stepping: false,
		cycle_stop: null,
		breakpoints: {},
		production: 'started',
		unconfirmed: false,
		undecided: {},
		resources: {},
		variables: {},
		abilities: {},
		operations: {},
		by_order: false,
		jobs: {},
		plan: PLAN,
		errand: null,
		last_errand: null,
		forces: {},
		out_of_service: [],
		questions: [],
		last_correction: null,
		approvals: {},
		tasks: {},
		topics: {},
		overrides: {},
		alarms: {},
		named_alarm: null,
		way_back: null,
		who_can: null,
		control: null,
		analysis: null,
		standby: null,
		deployment: null,
		...rest
	};
}
