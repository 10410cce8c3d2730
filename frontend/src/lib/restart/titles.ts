/** What operations and resources are called, for those of the station that are known. */
import type { StationView } from '#lib/contract.ts';

type Known = Pick<StationView, 'operations' | 'resources'> | null;

export function operationTitles(view: Known, names: readonly string[]): string[] {
	return names.map((name) => view?.operations[name]?.title ?? name);
}

export function resourceTitle(view: Known, name: string): string {
	return view?.resources[name]?.title ?? name;
}

/** The title of an ability as the page calls it; what is called otherwise where there is none of that name keeps `title`. */
export function abilityTitle(view: StationView | null, name: string, title: string): string {
	return view?.abilities[name]?.title ?? title;
}
