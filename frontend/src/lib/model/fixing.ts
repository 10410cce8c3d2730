/** What a finding offers to write in place of what it is about. */
import type { Finding, Fix } from '#lib/contract.ts';

/** The text of its file with a fix of a finding; null where that does not stand there any more. */
export function fixed(text: string, finding: Pick<Finding, 'line' | 'column'>, fix: Pick<Fix, 'was' | 'now'>): string | null {
	const lines = text.split('\n');
	const line = lines[finding.line - 1];
	if (line === undefined) return null;
	const from = wholeWord(line, fix.was, finding.column - 1);
	if (from < 0) return null;
	lines[finding.line - 1] = line.slice(0, from) + fix.now + line.slice(from + fix.was.length);
	return lines.join('\n');
}

/** Where a word stands that is no part of another, from a place on. */
function wholeWord(line: string, word: string, from: number): number {
	for (let at = line.indexOf(word, from); at >= 0; at = line.indexOf(word, at + 1))
		if (!/[\p{L}\p{N}_]/u.test((line[at - 1] ?? '') + (line[at + word.length] ?? ''))) return at;
	return -1;
}
