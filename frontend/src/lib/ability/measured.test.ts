import { expect, test } from 'vitest';
import type { TimeLine } from '#lib/contract.ts';
import { durationsOf, fitsUsual, usualOf } from './measured.svelte.ts';

test('runs that began and ended by themselves are measured, and no others', () => {
	const mark = (number: number, time: number, content: Record<string, string[]>): TimeLine['marks'][number] =>
		({ number, time, kind: 'ticked', content }) as unknown as TimeLine['marks'][number];
	const place = { number: 1, time: 0 } as TimeLine['first'];
	const line: TimeLine = {
		first: place,
		last: place,
		begin: 0,
		end: 9,
		running: ['before'],
		active: [],
		mode: null,
		marks: [
			mark(1, 1, { started: ['move', 'late'] }),
			mark(2, 2, { ended: ['before'] }),
			mark(3, 4, { ended: ['move'], started: ['move'] }),
			mark(4, 6, { called_off: ['late'] }),
			mark(5, 9, { ended: ['move'], started: ['move'] })
		],
		whole: true,
		alarms: [],
		bins: []
	};
	expect([...durationsOf(line, { from: 0, to: 10 })]).toEqual([['move', [3, 5]]]);
});

test('what is usual leaves the quickest and the slowest of many out', () => {
	expect(usualOf([])).toBeNull();
	expect(usualOf([5.04, 4])).toEqual({ least: 4, most: 5, runs: 2, median: 5.04 });
	expect(usualOf([0.1, 60, ...Array.from({ length: 18 }, (_, n) => 5 + n / 100)])).toMatchObject({ least: 5, most: 5.2, runs: 20 });
});

test('what is written fits where runs are usually about as long', () => {
	const usual = usualOf([4.9, 5.2, 5.8])!;
	expect(fitsUsual([2, 4], usual)).toBe(false);
	expect(fitsUsual([6, 9], usual)).toBe(false);
	expect(fitsUsual([2, 4.8], usual)).toBe(true);
	expect(fitsUsual([1, 2], usualOf([5, 5])!)).toBe(true);
});
