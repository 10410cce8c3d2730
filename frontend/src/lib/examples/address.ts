/** How the pages of the model and the questions to the server say that they are about an example station. */

/** The example that an address is about; null for the station's own draft. */
export function exampleIn(query: Pick<URLSearchParams, 'get'>): string | null {
	return query.get('example') || null;
}

/** The address of a page that shows the model, with what is looked at there: of an example as long as one is shown. */
export function shownAt(page: '/model' | '/operations' | '/pipelines', example: string | null, looked: Readonly<Record<string, string>> | URLSearchParams = {}): string {
	const query = new URLSearchParams(looked);
	if (example !== null) query.set('example', example);
	return query.size === 0 ? page : `${page}?${query}`;
}

/** Where the server is asked about the draft, or about an example in the same way. */
export function askedOf<Path extends string>(path: Path, example: string | null, more: Iterable<[string, string]> = []): Path | `${Path}?${string}` {
	const query = new URLSearchParams([...more]);
	if (example !== null) query.set('example', example);
	return query.size === 0 ? path : `${path}?${query}`;
}
