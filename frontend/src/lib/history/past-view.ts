/** The station as it was, as a document that a picture is drawn of. */
import type { Alarm, Past, PlanStep, StationView } from '#lib/contract.ts';

/**
 * `view`, with what is known of a moment of the past instead of what is so now, and with the alarms that stood then. Of tasks
 * and what was heard nothing is known of that moment; a variable that the past does not have is unknown.
 */
export function pastView(view: StationView, past: Past, alarms: Readonly<Record<string, Alarm>> = {}): StationView {
	const running = new Set(past.running);
	const active = new Set(past.active);
	const each = <From, To>(all: Readonly<Record<string, From>>, of: (one: From, name: string) => To): Record<string, To> =>
		Object.fromEntries(Object.entries(all).map(([name, one]) => [name, of(one, name)]));
	const steps = past.plan.steps.map((step, index): PlanStep => ({
		...step,
		id: String(index),
		resource: view.abilities[step.ability]?.resource ?? '',
		expected_start: null,
		expected_end: null,
		after: null,
		new: false,
		waits_for: [],
		waits_for_messages: [],
		sentence: null
	}));
	const serving = (name: string): string[] => steps.filter((_, index) => past.plan.steps[index]?.operations.includes(name)).map(({ id }) => id);
	return {
		...view,
		plan: { ...view.plan, status: past.plan.status, reason: past.plan.reason, reason_message: past.plan.reason_message, steps },
		way_back: null,
		mode: past.mode,
		packml: past.packml,
		production: past.production,
		stepping: past.stepping,
		by_order: past.by_order,
		jobs: past.jobs,
		variables: each(view.variables, (one, name) => ({ ...one, value: past.values[name] ?? null })),
		abilities: each(view.abilities, (one, name) => ({ ...one, executing: running.has(name), enabled: null, running_since: null })),
		operations: each(view.operations, (one, name) => ({ ...one, active: active.has(name), steps: serving(name), work: [] })),
		resources: each(view.resources, (one) => ({ ...one, online: true, awaited_topics: [] })),
		alarms,
		tasks: {}
	};
}
