/** The abilities of a station by resource, in the order in which the model has them. */
import type { Ability, StationView } from '#lib/contract.ts';

export interface Group {
	readonly resource: string;
	readonly title: string;
	readonly abilities: readonly (readonly [name: string, ability: Ability])[];
}

/** Each resource that has abilities. */
export function groupsOf({ resources, abilities }: Pick<StationView, 'resources' | 'abilities'>): Group[] {
	const all = Object.entries(abilities);
	const names = [...new Set([...Object.keys(resources), ...all.map(([, { resource }]) => resource)])];
	return names
		.map((resource) => ({
			resource,
			title: resources[resource]?.title ?? resource,
			abilities: all.filter(([, ability]) => ability.resource === resource)
		}))
		.filter((group) => group.abilities.length > 0);
}
