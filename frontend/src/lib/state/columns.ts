/** The columns of the list, and which of them a person has put away on this device. */

export const COLUMNS = ['name', 'value', 'kind', 'age', 'writer', 'trend', 'act'] as const;
export type ColumnId = (typeof COLUMNS)[number];

/** Those that may be put away. */
export const OPTIONAL = ['kind', 'age', 'writer', 'trend'] as const satisfies readonly ColumnId[];

const KEY = 'state-columns-hidden';

/** The columns that were put away. */
export function keptHidden(): readonly ColumnId[] {
	try {
		const kept = (localStorage.getItem(KEY) ?? '').split(',');
		return OPTIONAL.filter((each) => kept.includes(each));
	} catch {
		return [];
	}
}

/** Keeps them; where the browser does not let it they last as long as the page. */
export function keepHidden(hidden: readonly ColumnId[]): void {
	try {
		if (hidden.length > 0) localStorage.setItem(KEY, hidden.join(','));
		else localStorage.removeItem(KEY);
	} catch {
		// As long as the page.
	}
}
