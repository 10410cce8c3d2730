import { expect, test } from 'vitest';
import { estimate, view } from '#lib/testing/view.ts';
import { fullName, valueOf } from '#lib/wording/names.svelte.ts';
import { agoWords, evidenceText, spanOf } from './words.ts';

test('values are said in words', () => {
	expect([true, false, null, 7, 'above_engine'].map((value) => valueOf('v', value))).toEqual(['yes', 'no', 'unknown', '7', 'above engine']);
});

test('what was measured is said as variables and values are called', () => {
	const shown = view({ variables: { 'robot.pose': estimate(), b: estimate(), n: estimate() } });
	const said = ['robot.pose == above_engine', 'b', 'not b', 'n == 3', 'odd (text)'].map((each) => evidenceText(shown, each));
	expect(said).toEqual(['Robot.pose: above engine', 'B: yes', 'B: no', 'N: 3', 'odd (text)']);
});

test('spans of time get coarser as they grow', () => {
	expect([-1, 0.9, 119, 120, 7199, 7200, 172799, 172800].map(spanOf)).toEqual([
		[0, 's'],
		[0, 's'],
		[119, 's'],
		[2, 'min'],
		[119, 'min'],
		[2, 'h'],
		[47, 'h'],
		[2, 'days']
	]);
});

test('nothing is said to be just now on a view that is old', () => {
	expect([agoWords(0.5, true), agoWords(0.5, false), agoWords(130, true)]).toEqual(['just now', '0 s before', '2 min ago']);
});

test('where its resource is not in sight a variable is called after it', () => {
	const robot = { title: 'Robot', online: true, awaited_topics: [] };
	const shown = view({ resources: { robot }, variables: { 'robot.pose': estimate({ resource: 'robot' }), b: estimate() } });
	expect([fullName(shown, 'robot.pose'), fullName(shown, 'b'), fullName(null, 'b')]).toEqual(['Robot · Pose', 'B', 'B']);
});
