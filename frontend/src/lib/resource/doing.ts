/** The abilities of each resource, gone through once for all of them. */
import type { Ability, StationView } from '#lib/contract.ts';
import { runs } from './running.ts';

export interface Doing {
	readonly abilities: readonly (readonly [name: string, ability: Ability])[];
	readonly running: readonly Ability[];
}

export const NOTHING: Doing = { abilities: [], running: [] };

export function doingOf(abilities: StationView['abilities']): ReadonlyMap<string, Doing> {
	const all = new Map<string, { abilities: [string, Ability][]; running: Ability[] }>();
	for (const [name, ability] of Object.entries(abilities)) {
		let doing = all.get(ability.resource);
		if (doing === undefined) all.set(ability.resource, (doing = { abilities: [], running: [] }));
		doing.abilities.push([name, ability]);
		if (runs(ability)) doing.running.push(ability);
	}
	return all;
}
