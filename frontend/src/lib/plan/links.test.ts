import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { PlanStep } from '#lib/contract.ts';
import { step } from '#lib/testing/view.ts';
import { layOut, type Lane } from './lanes.ts';
import { linksOf, pathOf } from './links.ts';

const NOW = 1000;
const lanesOf = (steps: readonly PlanStep[]): Lane[] => layOut(steps, ['operator', 'nutrunner', 'robot'], NOW, { words: 0, mark: 0 });
const running = step('place', 'operator', 0, { status: 'running', started: NOW - 4, expected_end: NOW + 2 });
const tighten = step('tighten', 'nutrunner', 1, { status: 'next', expected_start: NOW + 2, expected_end: NOW + 6, after: 'place' });
const move = step('move', 'robot', 2, { expected_start: NOW + 6, expected_end: NOW + 8, after: 'tighten' });

describe('lines of what waits for what', () => {
	test('lead from the end of the one to the beginning of the other', () => {
		expect(linksOf(lanesOf([running, tighten, move]))).toEqual([
			{ from: 'place', to: 'tighten', leaves: 2, arrives: 2, lanes: [0, 1], rows: [0, 0] },
			{ from: 'tighten', to: 'move', leaves: 6, arrives: 6, lanes: [1, 2], rows: [0, 0] }
		]);
	});

	test('are not drawn within a lane, nor to what has begun, nor from what is not drawn', () => {
		const back = step('back', 'robot', 3, { expected_start: NOW + 8, expected_end: NOW + 9, after: 'move' });
		expect(linksOf(lanesOf([move, back]))).toEqual([]);
		expect(linksOf(lanesOf([running, { ...tighten, status: 'running', started: NOW - 1 }]))).toEqual([]);
		expect(linksOf(lanesOf([{ ...tighten, after: 'gone' }]))).toEqual([]);
	});

	test('never lead back in time', () => {
		const times = fc.array(fc.record({ after: fc.integer({ min: 0, max: 9 }), takes: fc.integer({ min: 0, max: 30 }) }), { maxLength: 12 });
		fc.assert(
			fc.property(times, (all) => {
				const steps = all.map(({ after, takes }, k) =>
					step(`s${k}`, ['operator', 'nutrunner', 'robot'][k % 3] ?? '', k, {
						expected_start: NOW + k,
						expected_end: NOW + k + takes,
						after: k > 0 ? `s${Math.min(k - 1, after)}` : null
					})
				);
				for (const { leaves, arrives } of linksOf(lanesOf(steps))) {
					expect(leaves).toBeGreaterThanOrEqual(0);
					expect(leaves).toBeLessThanOrEqual(arrives);
				}
			})
		);
	});

	test('bend before their end, or half way where there is no room', () => {
		expect(pathOf(1, 2, 9, 6, 0.5)).toBe('M1 2H8.5V6H9');
		expect(pathOf(9, 2, 9, 6, 0.5)).toBe('M9 2H9V6H9');
	});
});
