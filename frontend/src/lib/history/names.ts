/** What abilities, operations and variables of the past are called: by the titles of the model that runs now. */
import type { StationView, Value } from '#lib/contract.ts';
import { fullName, valueOf } from '#lib/wording/names.svelte.ts';

export interface Names {
	readonly ability: (id: string) => string;
	readonly operation: (id: string) => string;
	readonly variable: (id: string) => string;
	/** What a value of a variable is called. */
	readonly value: (variable: string, value: unknown) => string;
	readonly resource: (id: string) => string;
	/** The resource that an ability is of. */
	readonly resourceOf: (ability: string) => string;
}

function isValue(value: unknown): value is Value {
	return typeof value === 'string' || typeof value === 'number' || typeof value === 'boolean';
}

/** Names of `view`. What is not in it any more keeps the name that it had in the model. */
export function namesOf(view: StationView | null): Names {
	const resource = (id: string): string => view?.resources[id]?.title ?? id;
	return {
		ability: (id) => view?.abilities[id]?.title ?? id,
		operation: (id) => view?.operations[id]?.title ?? id,
		variable: (id) => fullName(view, id),
		value: (variable, value) =>
			value === undefined || value === null || isValue(value) ? valueOf(variable, value ?? null) : JSON.stringify(value),
		resource,
		resourceOf: (ability) => view?.abilities[ability]?.resource ?? ability.split('.')[0] ?? ability
	};
}
