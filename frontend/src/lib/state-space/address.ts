/** Of more starts than this an address would be too long: the first will do. */
const MOST_CUT = 40;

/** The address of the state space in which it is shown where these starts are kept back. */
export function spaceOf(starts: readonly string[]): string {
	const query = new URLSearchParams({ space: 'on' });
	for (const name of starts.slice(0, MOST_CUT)) query.append('cut', name);
	return `/what-if?${query}`;
}
