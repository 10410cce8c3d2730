/** What a person looks at on the page Model, as it stands in its address. */
import { exampleIn, shownAt } from '#lib/examples/address.ts';
import { panelIn, type PanelName } from './panels.ts';

export interface Looked {
	/** The example station that is looked at; null for the draft. */
	readonly example: string | null;
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
	/** The example stations are asked for. */
	readonly examples: boolean;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const text = query.get('text') !== 'off';
	const panel = panelIn(query);
	const [entry, file, line] = [query.get('entry'), query.get('file'), Number(query.get('line'))];
	const ability = query.get('ability') || null;
	const rest = { example: exampleIn(query), place: null, ability: null, graph: query.get('view') === 'graph', text, panel, examples: query.get('examples') !== null };
	if (entry === null && file !== null) return { ...rest, entry, place: { file, line: line > 0 ? line : 1 } };
	if (entry === null && ability !== null) return { ...rest, entry, ability };
	return { ...rest, entry: entry ?? 'station.yaml' };
}

export function addressOf({ entry, text = true, example = null }: { readonly entry: string; readonly text?: boolean; readonly example?: string | null }): string {
	return shownAt('/model', example, { entry, ...(!text && { text: 'off' }) });
}

/** The line of a file, and what is shown below the form. */
export function placeIn(example: string | null, { file, line }: { readonly file: string; readonly line: number }, panel: PanelName | null = null): string {
	return shownAt('/model', example, { file, line: String(line), ...(panel !== null && { panel }) });
}

/** The same address with the example stations asked for, or without. */
export function besideExamples(address: Iterable<[string, string]>, examples: boolean): string {
	const query = new URLSearchParams([...address].filter(([key]) => key !== 'examples'));
	if (examples) query.set('examples', 'on');
	return query.size === 0 ? '/model' : `/model?${query}`;
}

/** The same address with the file shown beside the form, or without. */
export function besideText(address: Iterable<[string, string]>, text: boolean): string {
	const query = new URLSearchParams([...address]);
	if (text) query.delete('text');
	else query.set('text', 'off');
	return `/model?${query}`;
}
