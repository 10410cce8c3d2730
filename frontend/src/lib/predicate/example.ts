/** An example of a condition, of a variable that the station has. */
import type { StationView } from '#lib/contract.ts';
import { becoming } from './becoming.ts';

/** That its first variable with few values becomes another one: what is typed so is understood. */
export function exampleOf(view: Pick<StationView, 'variables'> | null): string {
	const all = Object.entries(view?.variables ?? {});
	const [name, variable] = all.find(([, { domain }]) => domain.length > 2) ?? all[0] ?? [];
	return name === undefined || variable === undefined ? '' : becoming(name, variable);
}
