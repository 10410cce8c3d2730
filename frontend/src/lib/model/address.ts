/** What a person looks at on the page Model, as it stands in its address. */
export interface Looked {
	/** The entry that is chosen. */
	readonly entry: string;
	/** Whether the file is shown beside the form. */
	readonly text: boolean;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	return { entry: query.get('entry') ?? 'station.yaml', text: query.get('text') !== 'off' };
}

export function addressOf({ entry, text }: Looked): string {
	const query = new URLSearchParams({ entry });
	if (!text) query.set('text', 'off');
	return `/model?${query}`;
}
