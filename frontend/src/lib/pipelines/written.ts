/** Stages as they go through the clipboard: YAML, as files have them, with the comments in them and directly above. */
import type { Document } from 'yaml';
import type { Json } from '#lib/contract.ts';
import { asJson, isMapping, type Path } from '#lib/model/content.ts';
import { PARTS } from '#lib/model/documents.ts';

export type Yaml = typeof import('yaml');

/** A stage that is to be written: what it says, and how, where that is known. */
export interface Written {
	readonly value: Json;
	/** With its comments, and with nothing that stands for something else. */
	readonly text: string | null;
}

/** A stage at `path` of a file as it would be written in a list of stages; what it says alone where the file has it otherwise. */
export function textOf(yaml: Yaml, stage: Json, file: string, path: Path): string {
	const document = yaml.parseDocument(file);
	const text = entryOf(yaml, file, document, document.errors.length > 0 ? null : document.getIn(path.slice(0, -1), true), Number(path.at(-1)));
	return text !== null && isSame(readBy(yaml, text), [stage]) ? text : yaml.stringify([stage]);
}

/** The stages that a text has, one or a list of them; null where it has something else. */
export async function stagesIn(text: string): Promise<readonly Written[] | null> {
	const yaml = await import('yaml');
	const read = readBy(yaml, text);
	const all: unknown[] = Array.isArray(read) ? read : [read];
	if (all.length === 0 || !all.every(isStage)) return null;
	const document = yaml.parseDocument(text);
	return (all as Json[]).map((value, at) => {
		const entry = entryOf(yaml, text, document, document.contents, at);
		const made = entry === null ? null : valueIn(entry);
		// Without a comment it is written in the style of what is around it.
		return { value, text: made?.includes('#') === true && isSame(readBy(yaml, made), value) ? made : null };
	});
}

function readBy({ parse }: Yaml, text: string): unknown {
	try {
		return parse(text);
	} catch {
		return undefined;
	}
}

const isSame = (one: unknown, other: unknown): boolean => JSON.stringify(one) === JSON.stringify(other);

/**
 * The lines of an entry of a list, with the comments directly above it and those below that are indented more, at the beginning
 * of their lines. What an alias stands for is written where it stands, and no anchor is left. Null for a list in brackets.
 */
function entryOf(yaml: Yaml, text: string, document: Document, list: unknown, at: number): string | null {
	if (!yaml.isSeq(list) || list.flow === true) return null;
	const node = list.items[at];
	const range = yaml.isNode(node) ? node.range : null;
	if (!range) return null;
	const lines = text.split('\n');
	const lineOf = (index: number): number => text.slice(0, index).split('\n').length - 1;
	let first = lineOf(range[0]);
	const margin = lines[first]?.indexOf('-') ?? -1;
	if (margin < 0 || !/^ *- /.test(lines[first] ?? '')) return null;
	const isComment = (line: string | undefined): boolean => line?.trimStart().startsWith('#') === true;
	const columnOf = (line: string | undefined): number => (line ?? '').search(/\S/);
	while (isComment(lines[first - 1]) && columnOf(lines[first - 1]) === margin) first -= 1;
	let last = lineOf(Math.max(range[0], range[1] - 1));
	for (let next = last + 1; next < lines.length && (lines[next]?.trim() === '' || (isComment(lines[next]) && columnOf(lines[next]) > margin)); next++) if (isComment(lines[next])) last = next;
	const begin = lines.slice(0, first).reduce((sum, line) => sum + line.length + 1, 0);
	const end = lines.slice(0, last + 1).reduce((sum, line) => sum + line.length + 1, 0);
	const alone = spelledOut(yaml, text, document, begin, end);
	return alone === null ? null : `${alone.replace(/\n+$/, '').split('\n').map((line) => line.slice(Math.min(margin, Math.max(columnOf(line), 0)))).join('\n')}\n`;
}

/** A part of a text, with values in the place of aliases and without anchors; null where one stands for nothing. */
function spelledOut(yaml: Yaml, text: string, document: Document, begin: number, end: number): string | null {
	const meant = new Map<number, string>();
	yaml.visit(document, {
		Alias: (_, alias) => {
			const value: unknown = alias.resolve(document)?.toJS(document);
			if (alias.range && value !== undefined) meant.set(alias.range[0], yaml.stringify(value, { collectionStyle: 'flow', flowCollectionPadding: false, lineWidth: 0 }).trimEnd());
		}
	});
	let [made, at, wasAnchor] = ['', 0, false];
	for (const token of new yaml.Lexer().lex(text)) {
		const kind = yaml.CST.tokenType(token);
		// Marks of the lexer are no part of the text.
		if (/^[\u0002\u0018\u001f]$/.test(token)) continue;
		const isIn = at >= begin && at < end;
		if (isIn && kind === 'alias') {
			const value = meant.get(at);
			if (value === undefined || value.includes('\n')) return null;
			made += value;
		} else if (isIn && kind !== 'anchor' && !(wasAnchor && kind === 'space')) made += token;
		wasAnchor = kind === 'anchor';
		at += token.length;
	}
	return made;
}

/** What an entry of a list has behind its dash; comments that stand above that stay so. */
function valueIn(entry: string): string {
	const lines = entry.split('\n');
	const first = lines.findIndex((line) => line.startsWith('-'));
	const column = (lines[first] ?? '').slice(1).search(/\S/) + 1;
	return lines.map((line, at) => (at < first ? line : at === first ? line.slice(column) : line.slice(Math.min(column, Math.max(line.search(/\S/), 0))))).join('\n');
}

function isStage(value: unknown): boolean {
	if (!isMapping(asJson(value as Json))) return false;
	const kinds = Object.keys(value as object);
	return kinds.length === 1 && kinds.every((kind) => kind in (PARTS['stage']?.fields ?? {}));
}
