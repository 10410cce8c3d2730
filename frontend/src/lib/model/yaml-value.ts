/** What is written behind the key of an entry in a file, without the key and as if it stood alone. */
import { keyOf, type Placed } from './places.ts';

/** Signs by which the lines of what stands below a key are further in than it. */
const STEP = 2;
/** The first line of what stands below its key, and not beside it: an item, a comment, a key of its own. */
const BELOW = /^(-(\s|$)|#|\?(\s|$)|("(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[^\s"'[\]{}&*!|>%@`#][^#]*?)\s*:(\s|$))/;

const indentOf = (line: string): number => line.length - line.trimStart().length;
const marginOf = (lines: readonly string[]): number => Math.min(...lines.filter((line) => line.trim() !== '').map(indentOf));
/** The lines, further in by so many signs; empty lines stay empty. */
function movedIn(lines: readonly string[], by: number): string[] {
	return lines.map((line) => (line.trim() === '' ? '' : ' '.repeat(Math.max(0, indentOf(line) + by)) + line.trimStart()));
}
/** The lines, the one that is furthest out at the margin `to`. */
const shifted = (lines: readonly string[], to: number): string[] => movedIn(lines, to - marginOf(lines));

/** The value of the entry that stands there. */
export function valueText(text: string, { from, to }: Placed): string {
	const [first = '', ...below] = text.split('\n').slice(from, to);
	const key = keyOf(first);
	const beside = key?.value ?? first.trim();
	if (beside === '') return shifted(below, 0).join('\n');
	// What goes on from beside the key may stand in columns of its own.
	return [beside, ...movedIn(below, -Math.min((key?.indent ?? 0) + STEP, marginOf(below)))].join('\n');
}

/** The text with another value of that entry. */
export function withValue(text: string, { from, to }: Placed, value: string): string {
	const all = text.split('\n');
	const key = keyOf(all[from] ?? '');
	const lines = value.replace(/\s+$/, '').split('\n');
	const margin = (key?.indent ?? 0) + STEP;
	const [first = '', ...others] = lines;
	const before = key?.value === '' ? all.slice(from + 1, to).find((line) => line.trim() !== '') : undefined;
	const stoodBelow = before !== undefined && !BELOW.test(before.trimStart());
	const now = first !== '' && (stoodBelow || BELOW.test(first.trimStart()))
		? [`${key?.head ?? ''}:`, ...shifted(lines, margin)]
		: [`${key?.head ?? ''}: ${first.trim()}`.trimEnd(), ...movedIn(others, margin)];
	return [...all.slice(0, from), ...now, ...all.slice(to)].join('\n');
}
