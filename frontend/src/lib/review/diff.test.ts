import { expect, test } from 'vitest';
import { readDifference, type Line } from './diff.ts';

const shown = ({ kind, old, new: next, text, left }: Line): string =>
	`${kind} ${old ?? '-'} ${next ?? '-'} ${kind === 'skip' ? left : text}`;

test('lines have the numbers that they had and have, and what is left out is counted', () => {
	const { lines, added, taken } = readDifference(
		[
			'--- a/station.yaml',
			'+++ b/station.yaml',
			'@@ -3,3 +3,4 @@',
			' name: bolts',
			'-title: Old',
			'+title: New',
			'+description: More',
			' ',
			'@@ -20,2 +21 @@',
			' end',
			'--- a dash',
			''
		].join('\n')
	);
	expect(lines.map(shown)).toEqual([
		'skip - - 2',
		'same 3 3 name: bolts',
		'taken 4 - title: Old',
		'added - 4 title: New',
		'added - 5 description: More',
		'same 5 6 ',
		'skip - - 14',
		'same 20 21 end',
		'taken 21 - -- a dash'
	]);
	expect([added, taken]).toEqual([2, 2]);
});

test('a file that is new begins with its first line', () => {
	const { lines } = readDifference('--- a/x\n+++ b/x\n@@ -0,0 +1,2 @@\n+one\n+two\n');
	expect(lines.map(shown)).toEqual(['added - 1 one', 'added - 2 two']);
});

test('what has no new line at its end is said to', () => {
	const { lines } = readDifference('--- a/x\n+++ b/x\n@@ -1 +1 @@\n-one\n\\ No newline at end of file\n+one\n');
	expect(lines.map(({ kind }) => kind)).toEqual(['taken', 'note', 'added']);
});
