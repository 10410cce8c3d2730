/** What a person looks at on the page Model, as it stands in its address. */
import { panelIn, type PanelName } from './panels.ts';

export interface Looked {
	/** The entry that is chosen; null where a line of a file or an ability is. */
	readonly entry: string | null;
	/** The file and the line that are asked for instead, as other pages lead to them. */
	readonly place: { readonly file: string; readonly line: number } | null;
	/** The ability of the station that is asked for instead, with what stands for its parameters. */
	readonly ability: string | null;
	/** The graph of all parts is shown in place of form and file. */
	readonly graph: boolean;
	/** Whether the file is shown beside the form. */
	readonly text: boolean;
	/** What is to be shown below the form; null: whatever was. */
	readonly panel: PanelName | null;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const text = query.get('text') !== 'off';
	const panel = panelIn(query);
	const [entry, file, line] = [query.get('entry'), query.get('file'), Number(query.get('line'))];
	const ability = query.get('ability') || null;
	const rest = { place: null, ability: null, graph: query.get('view') === 'graph', text, panel };
	if (entry === null && file !== null) return { ...rest, entry, place: { file, line: line > 0 ? line : 1 } };
	if (entry === null && ability !== null) return { ...rest, entry, ability };
	return { ...rest, entry: entry ?? 'station.yaml' };
}

export function addressOf({ entry, text }: { readonly entry: string; readonly text: boolean }): string {
	const query = new URLSearchParams({ entry });
	if (!text) query.set('text', 'off');
	return `/model?${query}`;
}

/** The same address with the file shown beside the form, or without. */
export function besideText(address: Iterable<[string, string]>, text: boolean): string {
	const query = new URLSearchParams([...address]);
	if (text) query.delete('text');
	else query.set('text', 'off');
	return `/model?${query}`;
}
