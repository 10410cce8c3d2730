/** All that an ability is made of, as the rows of a table. */
import type { AbilityAction, AbilityAutomaton, Conjunct, Predicate } from '#lib/contract.ts';

export type PartName =
	| 'enabled'
	| 'start'
	| 'startActions'
	| 'supervised'
	| 'executing'
	| 'finish'
	| 'finishActions'
	| 'finished'
	| 'cancelActions'
	| 'reaction';

export interface Row {
	readonly part: PartName;
	/** Of a reaction: its name. */
	readonly of: string;
	readonly text: string;
	/** Whether it holds, or is set so; null where that is not known. */
	readonly now: boolean | null;
	/** An action is set or not; a condition holds or not. */
	readonly action: boolean;
	readonly reads: Conjunct['reads'];
	readonly place: Predicate['place'];
}

function conditions(part: PartName, predicate: Predicate | null, of = ''): Row[] {
	if (predicate === null) return [];
	const { place } = predicate;
	if (predicate.parts.length === 0)
		return [{ part, of, text: predicate.text, now: predicate.holds, action: false, reads: [], place }];
	return predicate.parts.map(({ text, holds, reads }) => ({ part, of, text, now: holds, action: false, reads, place }));
}

function actions(part: PartName, all: readonly AbilityAction[], of = ''): Row[] {
	return all.map(({ text, done }) => ({ part, of, text, now: done, action: true, reads: [], place: null }));
}

/** Its rows, in the order in which a run goes through them. */
export function rowsOf(definition: AbilityAutomaton): Row[] {
	return [
		...conditions('enabled', definition.enabled),
		...conditions('start', definition.start),
		...conditions('supervised', definition.supervised?.guard ?? null),
		...actions('startActions', definition.start_actions),
		...conditions('executing', definition.executing),
		...definition.reactions.flatMap(({ name, guard, actions: changes }) => [
			...conditions('reaction', guard, name),
			...actions('reaction', changes, name)
		]),
		...conditions('finish', definition.finish),
		...actions('finishActions', definition.finish_actions),
		...conditions('finished', definition.finished),
		...actions('cancelActions', definition.cancel_actions)
	];
}
