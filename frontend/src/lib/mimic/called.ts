import type { Mimic, MimicSymbol, StationView } from '#lib/contract.ts';
import { nameOf, stopOf } from './describe.ts';

/** How a resource is drawn and called elsewhere as it is in the picture. */
export interface Called extends Pick<MimicSymbol, 'symbol'> {
	readonly title: string;
	/** What the stop is called that an ability is about; null where the picture does not name it. */
	readonly stopOf: (ability: string) => string | null;
}

/** Those that the picture draws, by resource. */
export function calledIn(picture: Mimic | null, view: Pick<StationView, 'resources'> | null, language: string): ReadonlyMap<string, Called> {
	if (picture === null || view === null) return new Map();
	return new Map(
		picture.symbols.flatMap((symbol) => {
			if (symbol.resource === null) return [];
			const title = nameOf(symbol, view.resources, language);
			return [[symbol.resource, { symbol: symbol.symbol, title, stopOf: (ability: string) => stopOf(symbol, ability, language) }] as const];
		})
	);
}
