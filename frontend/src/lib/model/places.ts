/**
 * Where entries stand in the text of a file: found by indentation, as people see it, so that it works while the text is
 * being written and cannot be read. Entries within brackets stand where the brackets begin.
 */
import type { Path } from './content.ts';

export interface Placed {
	readonly path: Path;
	/** The first line of it, from 0. */
	readonly from: number;
	/** The line after the last of it. */
	readonly to: number;
}

interface Open {
	readonly indent: number;
	readonly path: Path;
	readonly from: number;
	readonly isItem: boolean;
	items: number;
}

const BLANK = /^\s*(#.*)?$/;
const KEY = /^("(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[^\s"'#[\]{}&*!|>%@`-](?:[^:#]|:(?=\S)|(?<=\S)#)*?|-[^\s:#](?:[^:#]|:(?=\S))*?)\s*:(?=\s|$)\s*(.*)$/;
const BLOCK = /^(?:[&!]\S+\s+)*[|>][-+0-9]*\s*(?:#.*)?$/;

const indentOf = (line: string): number => line.length - line.trimStart().length;

/** What a line begins with that has a key at its beginning: the key as it is written, and what stands beside it. */
export function keyOf(line: string): { readonly indent: number; readonly head: string; readonly value: string } | null {
	const indent = indentOf(line);
	const found = KEY.exec(line.slice(indent));
	return found ? { indent, head: line.slice(0, indent) + (found[1] ?? ''), value: (found[2] ?? '').trim() } : null;
}

const bare = (name: string): string => (/^["']/.test(name) ? name.slice(1, -1) : name);

/** How much deeper in brackets a text ends than it begins; what is quoted does not count. */
function deeper(text: string): number {
	const plain = text.replaceAll(/"(?:[^"\\]|\\.)*"|'(?:[^']|'')*'/g, '').replace(/(^|\s)#.*$/, '');
	return [...plain].reduce((depth, sign) => depth + ('[{'.includes(sign) ? 1 : ']}'.includes(sign) ? -1 : 0), 0);
}

/** All entries of a text, each before those in it. */
export function placesOf(text: string): Placed[] {
	const lines = text.split('\n');
	const found: { path: Path; from: number; to: number }[] = [];
	const open: (Open & { readonly place: { to: number } })[] = [];
	let root = 0;
	let last = 0; // the line after the last that says something
	let block = -1; // the indentation of the entry whose text goes on below it
	let depth = 0;

	function close(indent: number, alsoSame: (each: Open) => boolean): void {
		for (let top = open.at(-1); top && (top.indent > indent || (top.indent === indent && alsoSame(top))); top = open.at(-1)) {
			top.place.to = last;
			open.pop();
		}
	}
	function begin(indent: number, step: string | number, from: number): void {
		const path = [...(open.at(-1)?.path ?? []), step];
		const place = { path, from, to: from + 1 };
		found.push(place);
		open.push({ indent, path, from, isItem: typeof step === 'number', items: 0, place });
	}

	lines.forEach((line, index) => {
		if (block >= 0) {
			if (line.trim() === '') return;
			if (indentOf(line) > block) {
				last = index + 1;
				return;
			}
			block = -1;
		}
		if (BLANK.test(line)) return;
		if (depth > 0) {
			depth += deeper(line);
			last = index + 1;
			return;
		}
		let at = indentOf(line);
		let rest = line.slice(at);
		while (/^-(\s|$)/.test(rest)) {
			close(at, (each) => each.isItem);
			const parent = open.at(-1);
			begin(at, parent ? parent.items++ : root++, index);
			const next = rest.slice(1);
			at += 1 + indentOf(next);
			rest = next.trimStart();
		}
		const key = KEY.exec(rest);
		const value = key ? (key[2] ?? '') : rest;
		if (key) {
			close(at, () => true);
			begin(at, bare(key[1] ?? ''), index);
		}
		if (BLOCK.test(value)) block = open.at(-1)?.indent ?? 0;
		else depth = Math.max(0, deeper(value));
		last = index + 1;
	});
	close(-1, () => true);
	return found;
}

const begins = (path: Path, way: Path): boolean => way.length <= path.length && way.every((step, at) => path[at] === step);

/** Where the entry at `path` stands, or the nearest around it; null where there is none. */
export function placeOf(places: readonly Placed[], path: Path): Placed | null {
	return places.reduce<Placed | null>(
		(best, each) => (begins(path, each.path) && each.path.length > (best?.path.length ?? 0) ? each : best),
		null
	);
}

/** The path of the innermost entry that line `line` (from 1) belongs to; empty for none. */
export function pathAt(places: readonly Placed[], line: number): Path {
	const at = line - 1;
	return places.reduce<Path>(
		(best, each) => (each.from <= at && at < each.to && each.path.length > best.length ? each.path : best),
		[]
	);
}
