/** What a person looks at on the page Model, as it stands in its address. */
export interface Looked {
	/** The entry that is chosen; null where a line of a file is. */
	readonly entry: string | null;
	/** The file and the line that are asked for instead, as other pages lead to them. */
	readonly place: { readonly file: string; readonly line: number } | null;
	/** Whether the file is shown beside the form. */
	readonly text: boolean;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const text = query.get('text') !== 'off';
	const [entry, file, line] = [query.get('entry'), query.get('file'), Number(query.get('line'))];
	if (entry === null && file !== null) return { entry, place: { file, line: line > 0 ? line : 1 }, text };
	return { entry: entry ?? 'station.yaml', place: null, text };
}

export function addressOf({ entry, text }: { readonly entry: string; readonly text: boolean }): string {
	const query = new URLSearchParams({ entry });
	if (!text) query.set('text', 'off');
	return `/model?${query}`;
}
