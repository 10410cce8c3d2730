import { expect, test } from 'vitest';
import { leftText, sinceText } from './moment.ts';

test('how long ago something was is said in minutes or coarser, and never as before now', () => {
	expect([null, 1000, 1010, 941, 700, -6200].map((moment) => sinceText(moment, 1000))).toEqual([
		'never',
		'just now',
		'just now',
		'just now',
		'5 min ago',
		'2 h ago'
	]);
});

test('what is left of a time is never said as more than it is', () => {
	expect([1000, 1059, 1300, 1000 + 90 * 86400].map((moment) => leftText(moment, 1000))).toEqual([
		'less than a minute left',
		'less than a minute left',
		'5 min left',
		'90 days left'
	]);
});
