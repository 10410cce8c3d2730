/**
 * XML as robots are described in: elements with attributes. What a document may declare for itself is not taken, so nothing in it
 * can stand for another file or for a text without end. (A browser's own reader shows an error as a page with styles, which the
 * Content-Security-Policy refuses, and says the line in words of its own.)
 */
import { SaxesParser } from 'saxes';

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

/** The outermost element of a text. */
export function readXml(text: string): XmlElement | NotXml {
	const parser = new SaxesParser();
	const open: XmlElement[] = [];
	let root: XmlElement | null = null;
	let wrong: NotXml | null = null;
	// What follows the first error is not looked at: of a long text that is none each letter would be one.
	const refuse = (): never => {
		wrong ??= { line: parser.line };
		throw new Error('no XML');
	};
	parser.on('error', refuse);
	parser.on('doctype', refuse);
	parser.on('opentag', ({ name, attributes }) => {
		const element: XmlElement = { name: name.replace(/^.*:/, ''), attributes: new Map(Object.entries(attributes)), children: [] };
		const around = open.at(-1);
		if (around === undefined) root ??= element;
		else around.children.push(element);
		open.push(element);
	});
	parser.on('closetag', () => void open.pop());
	try {
		parser.write(text).close();
	} catch (error) {
		if (wrong === null) throw error;
	}
	return wrong ?? root ?? { line: 1 };
}
