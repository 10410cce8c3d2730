/** What is written behind the key of an entry in a file, without the key and as if it stood alone. */
import { keyOf, type Placed } from './places.ts';

/** Signs by which the lines of what stands below a key are further in than it. */
const STEP = 2;
/** The first line of what stands below its key, and not beside it: an item, a comment, a key of its own. */
const BELOW = /^(-(\s|$)|#|\?(\s|$)|("(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[^\s"'[\]{}&*!|>%@`#][^#]*?)\s*:(\s|$))/;

const indentOf = (line: string): number => line.length - line.trimStart().length;
/** The lines, the first of those that say something at the margin `to`; empty lines stay empty. */
function shifted(lines: readonly string[], to: number): string[] {
	const said = lines.filter((line) => line.trim() !== '');
	const by = to - Math.min(...said.map(indentOf));
	return lines.map((line) => (line.trim() === '' ? '' : ' '.repeat(Math.max(0, indentOf(line) + by)) + line.trimStart()));
}

/** The value of the entry that stands there. */
export function valueText(text: string, { from, to }: Placed): string {
	const [first = '', ...below] = text.split('\n').slice(from, to);
	const beside = keyOf(first)?.value ?? first.trim();
	const lines = shifted(below, 0);
	return [...(beside === '' ? [] : [beside]), ...lines].join('\n');
}

/** The text with another value of that entry. */
export function withValue(text: string, { from, to }: Placed, value: string): string {
	const all = text.split('\n');
	const key = keyOf(all[from] ?? '');
	const lines = value.replace(/\s+$/, '').split('\n');
	const margin = (key?.indent ?? 0) + STEP;
	const [first = '', ...others] = lines;
	const now = BELOW.test(first.trimStart())
		? [`${key?.head ?? ''}:`, ...shifted(lines, margin)]
		: [`${key?.head ?? ''}: ${first.trim()}`.trimEnd(), ...shifted(others, margin)];
	return [...all.slice(0, from), ...now, ...all.slice(to)].join('\n');
}
