/** A run that shows a finding, as it is played: place 0 is the initial state, place `n` the state after step `n`. */
import type { Trace, TraceStep, Value } from '#lib/contract.ts';

export interface Row {
	readonly name: string;
	readonly value: Value | null;
	/** What it was before the step; the same where the step does not change it. */
	readonly before: Value | null;
	readonly changed: boolean;
}

/** The step that leads to `place`; null for the initial state. */
export function stepTo(trace: Trace, place: number): TraceStep | null {
	return trace.steps[place - 1] ?? null;
}

/** The specifications that forbid the state at `place`. */
export function forbiddenAt(trace: Trace, place: number): readonly string[] {
	return place === 0 ? trace.forbidden_by : (stepTo(trace, place)?.forbidden_by ?? []);
}

/**
 * What happens in a step by name. Effects lose their arguments: of several instances that are alike there is one effect,
 * so they say too much.
 */
export function namesIn({ kind, names }: Pick<TraceStep, 'kind' | 'names'>): string {
	return names.map((name) => (kind === 'tick' ? name.replaceAll(/\([^)]*\)/g, '') : name)).join(', ');
}

/** The variables that a step of the run changes. */
export function moving(trace: Trace): ReadonlySet<string> {
	return new Set(trace.steps.flatMap((step) => Object.keys(step.changes)));
}

/** The values of all variables at `place`, by name. */
export function rowsAt(trace: Trace, place: number): Row[] {
	const before = valuesAt(trace, place - 1);
	const changes = stepTo(trace, place)?.changes ?? {};
	return Object.keys(trace.initial)
		.sort((one, other) => one.localeCompare(other))
		.map((name) => {
			const was = before[name] ?? null;
			const changed = Object.hasOwn(changes, name);
			return { name, value: changed ? (changes[name] ?? null) : was, before: was, changed };
		});
}

function valuesAt(trace: Trace, place: number): Readonly<Record<string, Value | null>> {
	return Object.assign({}, trace.initial, ...trace.steps.slice(0, Math.max(0, place)).map((step) => step.changes));
}

/** The abilities that start or finish in a run. */
export function acting(trace: Trace): string[] {
	const started = trace.steps.flatMap(({ kind, names }) => (kind === 'start' ? names : []));
	return [...new Set([...started, ...trace.steps.flatMap(({ finished }) => finished)])];
}

/** The ability that has last started or finished on the way to `place`; before the first that one. */
export function actingAt(trace: Trace, place: number): string | null {
	const until = { ...trace, steps: trace.steps.slice(0, place) };
	return acting({ ...until, steps: until.steps.slice(-1) })[0] ?? acting(until).at(-1) ?? acting(trace)[0] ?? null;
}
