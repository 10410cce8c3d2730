/** A column of a table. */
export interface Column {
	readonly id: string;
	readonly title: string;
	/** What is in it says enough for the eye. */
	readonly untitled?: boolean;
	/** Its track in the grid, as in `minmax(0, 2fr)`. */
	readonly width: string;
	/** How the rows are sorted by it; left out where they are not. */
	readonly sorted?: 'ascending' | 'descending' | undefined;
	/** Sorts by it, or the other way round; left out where it cannot be sorted by. */
	readonly sort?: (() => void) | undefined;
}
