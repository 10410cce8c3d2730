/** Which ability a person looks at, as it stands in the page's address. */

export const ABILITY = '/abilities';

/** The address of the page of an ability. */
export function addressOf(name: string): string {
	return `${ABILITY}?${new URLSearchParams({ name })}`;
}

/** The ability that the query of an address asks for. */
export function chosenIn(query: Pick<URLSearchParams, 'get'>): string | null {
	return query.get('name') || null;
}
