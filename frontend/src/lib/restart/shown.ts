/** When a person has to do with a restart at all: as long as the station works by itself, the page does not speak of one. */
import type { StationView, Value, Variable } from '#lib/contract.ts';

/** Whether there is anything to say of it. */
export function concernsRestart(view: StationView): boolean {
	return (
		view.mode !== 'automatic' ||
		view.errand !== null ||
		view.way_back !== null ||
		view.questions.length > 0 ||
		view.unconfirmed ||
		Object.keys(view.undecided).length > 0 ||
		(view.plan.status === 'none' && Object.values(view.operations).some((operation) => operation.active))
	);
}

/** The estimates that nobody has confirmed since they came back from the journal. */
export function unconfirmed(variables: Readonly<Record<string, Variable>>): [string, Variable & { value: Value }][] {
	return Object.entries(variables).flatMap(([name, variable]) =>
		isUnconfirmed(variable) && variable.value !== null ? [[name, { ...variable, value: variable.value }]] : []
	);
}

/** Whether nobody has seen since that the value is still true. */
export function isUnconfirmed(variable: Variable): boolean {
	return (variable.belief?.unconfirmed_since ?? null) !== null;
}
