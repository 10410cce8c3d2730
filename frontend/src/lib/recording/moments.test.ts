import { describe, expect, it } from 'vitest';
import type { RecordedMoment } from '#lib/contract.ts';
import { indexAt, momentText, nearest, tracksOf } from './moments.ts';

const change = (name: string): RecordedMoment['changes'][number] => ({ name, before: null, after: true, standing: 'recorded' });
const moment = (at: number, ...names: string[]): RecordedMoment => ({ at, changes: names.map(change) });
const moments = [moment(0, 'robot.pose'), moment(2, 'robot.moving', 'tool.idle'), moment(10, 'tool.idle')];
const resourceOf = (name: string): string => name.split('.')[0] ?? '';

describe('times of a recording', () => {
	it('are told to the thousandth', () => {
		expect(momentText(0)).toBe('0:00.000');
		expect(momentText(62.35)).toBe('1:02.350');
		expect(momentText(59.9996)).toBe('1:00.000');
	});
});

describe('a moment', () => {
	it('is the last by a time', () => {
		expect([-1, 0, 1.9, 2, 9, 10, 99].map((at) => indexAt(moments, at))).toEqual([-1, 0, 0, 1, 1, 2, 2]);
		expect(indexAt([], 3)).toBe(-1);
	});
	it('is found next to where somebody presses', () => {
		expect([-5, 0.9, 1.1, 5.9, 6.1, 99].map((at) => nearest(moments, at))).toEqual([0, 0, 1, 1, 2, 2]);
		expect(nearest([], 3)).toBe(-1);
	});
});

describe('the line', () => {
	it('has a track for each resource, with a mark where something of it changed', () => {
		expect(tracksOf(moments, { from: 0, to: 10 }, resourceOf)).toEqual([
			{ resource: 'robot', marks: [0, 0.2] },
			{ resource: 'tool', marks: [0.2, 1] }
		]);
	});
	it('has one mark where many would lie on each other', () => {
		const many = Array.from({ length: 1000 }, (_, n) => moment(n / 1000, 'robot.pose'));
		expect(tracksOf(many, { from: 0, to: 100 }, resourceOf)[0]?.marks.length).toBeLessThan(10);
	});
});
