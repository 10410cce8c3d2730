/**
 * XML as robots are described in: elements with attributes. What a document may declare for itself is not read, so nothing in it
 * can stand for another file or for a text without end. (A browser's own reader shows an error as a page with styles, which the
 * Content-Security-Policy refuses, and says the line in words of its own.)
 */
export interface XmlElement {
	/** Without the prefix of a namespace. */
	readonly name: string;
	readonly attributes: ReadonlyMap<string, string>;
	readonly children: XmlElement[];
}

/** It is no XML from this line on (from 1). */
export interface NotXml {
	readonly line: number;
}

const NAME = String.raw`[\p{L}_:][\p{L}\p{N}_:.\-]*`;
const ATTRIBUTE = String.raw`\s+(${NAME})\s*=\s*("[^"<]*"|'[^'<]*')`;
const PIECE = new RegExp(
	[
		String.raw`<!--[^]*?-->|<\?[^]*?\?>|<!\[CDATA\[[^]*?\]\]>`,
		String.raw`</(?<close>${NAME})\s*>`,
		String.raw`<(?<open>${NAME})(?<attributes>(?:${ATTRIBUTE.replaceAll(/\((?!\?)/g, '(?:')})*)\s*(?<empty>/?)>`,
		String.raw`(?<text>[^<]+)`
	].join('|'),
	'uy'
);
const ATTRIBUTES = new RegExp(ATTRIBUTE, 'gu');
/** What every document can say of a letter. */
const REFERENCE = /&(?:(amp|lt|gt|quot|apos)|#(\d+)|#x([\da-fA-F]+));|&/g;
const LETTERS: Readonly<Record<string, string>> = { amp: '&', lt: '<', gt: '>', quot: '"', apos: "'" };

/** The outermost element of a text. */
export function readXml(text: string): XmlElement | NotXml {
	const open: { readonly element: XmlElement; readonly tag: string }[] = [];
	let root: XmlElement | null = null;
	for (let at = 0; at < text.length; at = PIECE.lastIndex) {
		PIECE.lastIndex = at;
		const piece = PIECE.exec(text);
		if (piece === null) return { line: lineAt(text, at) };
		const { close, open: tag, attributes = '', empty, text: letters } = piece.groups ?? {};
		const inner = open.at(-1);
		if (letters !== undefined) {
			const bad = inner === undefined ? letters.search(/[^\s\ufeff]/) : unknownReference(letters);
			if (bad >= 0) return { line: lineAt(text, at + bad) };
		} else if (close !== undefined) {
			if (inner?.tag !== close) return { line: lineAt(text, at) };
			open.pop();
		} else if (tag !== undefined) {
			const read = attributesIn(attributes);
			if (read === null || (inner === undefined && root !== null)) return { line: lineAt(text, at) };
			const element: XmlElement = { name: tag.replace(/^.*:/, ''), attributes: read, children: [] };
			if (inner === undefined) root = element;
			else inner.element.children.push(element);
			if (empty === '') open.push({ element, tag });
		}
	}
	return root !== null && open.length === 0 ? root : { line: lineAt(text, text.length) };
}

function lineAt(text: string, at: number): number {
	return text.slice(0, at).split('\n').length;
}

/** Where something stands for what only the document could say; -1 where nothing does. */
function unknownReference(text: string): number {
	for (const found of text.matchAll(REFERENCE)) if (found[0] === '&') return found.index;
	return -1;
}

/** The values by their names; null where one is there twice, or stands for what is not known. */
function attributesIn(text: string): ReadonlyMap<string, string> | null {
	const found = new Map<string, string>();
	for (const [, name = '', quoted = ''] of text.matchAll(ATTRIBUTES)) {
		const value = quoted.slice(1, -1);
		if (found.has(name) || unknownReference(value) >= 0) return null;
		found.set(name, value.replaceAll(REFERENCE, (_, word?: string, decimal?: string, hex?: string) => letter(word, decimal, hex)));
	}
	return found;
}

function letter(word?: string, decimal?: string, hex?: string): string {
	if (word !== undefined) return LETTERS[word] ?? '';
	const code = decimal === undefined ? parseInt(hex ?? '', 16) : Number(decimal);
	return code <= 0x10ffff ? String.fromCodePoint(code) : '\ufffd';
}
