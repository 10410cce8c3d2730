/** What abilities, operations and variables of the past are called: by the titles of the model that runs now. */
import type { StationView } from '#lib/contract.ts';
import { variableName } from '#lib/wording/values.ts';

export interface Names {
	readonly ability: (id: string) => string;
	readonly operation: (id: string) => string;
	readonly variable: (id: string) => string;
	readonly resource: (id: string) => string;
	/** The resource that an ability is of. */
	readonly resourceOf: (ability: string) => string;
}

/** Names of `view`. What is not in it any more keeps the name that it had in the model. */
export function namesOf(view: StationView | null): Names {
	const resource = (id: string): string => view?.resources[id]?.title ?? id;
	return {
		ability: (id) => view?.abilities[id]?.title ?? id,
		operation: (id) => view?.operations[id]?.title ?? id,
		variable: (id) => {
			const of = view?.variables[id]?.resource ?? null;
			return of === null ? variableName(id, null) : `${resource(of)}: ${variableName(id, of)}`;
		},
		resource,
		resourceOf: (ability) => view?.abilities[ability]?.resource ?? ability.split('.')[0] ?? ability
	};
}
