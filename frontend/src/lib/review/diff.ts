/** A difference of two texts, as `diff -u` tells it, by lines with their numbers. */

export interface Line {
	/** `skip` stands for lines that are the same and not told, `note` for what is said about the line before. */
	readonly kind: 'same' | 'added' | 'taken' | 'skip' | 'note';
	/** The number of the line before, and after; null where it was not there. */
	readonly old: number | null;
	readonly new: number | null;
	readonly text: string;
	/** How many lines are left out, of `skip`. */
	readonly left: number;
}

export interface FileDifference {
	readonly lines: readonly Line[];
	readonly added: number;
	readonly taken: number;
}

const HUNK = /^@@ -(\d+)(?:,(\d+))? \+(\d+)(?:,(\d+))? @@/;

export function readDifference(unified: string): FileDifference {
	const lines: Line[] = [];
	const told = unified.split('\n');
	if (told.at(-1) === '') told.pop();
	let [old, next] = [1, 1];
	// Two lines name the files.
	for (const line of told.slice(2)) {
		const hunk = HUNK.exec(line);
		if (hunk) {
			const begins = beginning(hunk[1], hunk[2]);
			if (begins > old) lines.push({ kind: 'skip', old: null, new: null, text: '', left: begins - old });
			[old, next] = [begins, beginning(hunk[3], hunk[4])];
		} else if (line.startsWith('+')) lines.push({ kind: 'added', old: null, new: next++, text: line.slice(1), left: 0 });
		else if (line.startsWith('-')) lines.push({ kind: 'taken', old: old++, new: null, text: line.slice(1), left: 0 });
		else if (line.startsWith('\\')) lines.push({ kind: 'note', old: null, new: null, text: '', left: 0 });
		else lines.push({ kind: 'same', old: old++, new: next++, text: line.slice(1), left: 0 });
	}
	const count = (kind: Line['kind']): number => lines.filter((line) => line.kind === kind).length;
	return { lines, added: count('added'), taken: count('taken') };
}

/** The first line of a hunk; an empty one is told by the line before it. */
function beginning(first = '1', length = '1'): number {
	return Number(first) + (length === '0' ? 1 : 0);
}
