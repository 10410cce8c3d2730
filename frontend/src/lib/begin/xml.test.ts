import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { readXml, type NotXml, type XmlElement } from './xml.ts';

/** An element as a list: its name, its attributes, and what is in it. */
function told(read: XmlElement | NotXml): unknown {
	return 'line' in read ? read : [read.name, Object.fromEntries(read.attributes), ...read.children.map(told)];
}

test('elements are read with their attributes, whatever stands between', () => {
	const text = `\ufeff<?xml version="1.0" encoding="UTF-8"?>
<!-- <robot> -->
<robot name='läge &amp; &quot;co&#34;&#x41;' xmlns:xacro="http://www.ros.org/wiki/xacro">
	text &lt; here <![CDATA[<not read>]]>
	<xacro:macro  name = "a"
		b=">" />
	<group></group >
</robot>
`;
	expect(told(readXml(text))).toEqual([
		'robot',
		{ name: 'läge & "co"A', 'xmlns:xacro': 'http://www.ros.org/wiki/xacro' },
		['macro', { name: 'a', b: '>' }],
		['group', {}]
	]);
});

test.each([
	['', 1],
	['words', 1],
	['<a>\n<b>\n</a>', 3],
	['<a>\n<b>', 2],
	['<a/>\n<b/>', 2],
	['<a/>\nwords', 2],
	['<a\nb>', 2],
	['<a b=c/>', 1],
	['<a b="1" b="2"/>', 1],
	['<a>\n\n&nowhere;</a>', 3],
	['<a b="&nowhere;"/>', 1],
	['<a b="<"/>', 1],
	['<a>\n<!-- no end </a>', 2],
	['<!DOCTYPE a>\n<a/>', 1],
	['<a></A>', 1],
	['<1/>', 1],
	['</a>', 1]
])('%j is none', (text, line) => {
	expect(readXml(text)).toEqual({ line });
});

describe('whatever the text', () => {
	test('is, it is read or said to be none', () => {
		const piece = fc.constantFrom('<', '>', '</', '/>', '<a', '<a>', '</a>', ' b="', '"', '&', '&amp;', '<!--', '-->', '<![CDATA[', ']]>', '\n', 'x', '<?', '?>');
		fc.assert(
			fc.property(fc.array(piece, { maxLength: 40 }), (pieces) => {
				const read = readXml(pieces.join(''));
				if ('line' in read) expect(read.line).toBeGreaterThanOrEqual(1);
			})
		);
	});

	test('holds of blanks, brackets or depth, it is read', () => {
		const texts = [`<a${' '.repeat(500_000)}`, '<'.repeat(500_000), `<a ${'b="1" '.repeat(100_000)}`, '<a>'.repeat(200_000), `<!--${'-'.repeat(500_000)}`];
		expect(texts.map(readXml)).toEqual(texts.map(() => ({ line: 1 })));
	});
});
