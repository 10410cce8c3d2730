import { besideView } from '#lib/what-if/address.ts';

/** Of more starts than this an address would be too long: the first will do. */
const MOST_CUT = 40;

/** The address of the state space in which it is shown where these starts are kept back. */
export function spaceOf(starts: readonly string[]): string {
	return besideView(
		starts.slice(0, MOST_CUT).map((name) => ['cut', name]),
		'space'
	);
}

/** The starts of which an address asks where they are kept back. */
export function cutIn(query: Pick<URLSearchParams, 'getAll'>): readonly string[] {
	return query.getAll('cut');
}

/** The same address, where all of it is looked at. */
export function withoutCut(address: Iterable<[string, string]>): string {
	return besideView([...address].filter(([key]) => key !== 'cut'), 'space');
}
