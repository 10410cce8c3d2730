import { expect, test } from 'vitest';
import type { Job } from '#lib/contract.ts';
import { operation, view } from '#lib/testing/view.ts';
import { countOf } from './count.ts';
import { standingsOf } from './standing.ts';

test('the operations of the order in work are counted as Orders counts them, and all where there is none or are several', () => {
	const step = (state: Job['steps'][string]['state']): Job['steps'][string] => ({ state, waits_for: [], started: null, ended: null });
	const steps = { place: step('completed'), tighten: step('skipped'), leave: step('active') };
	const job = { state: 'running', steps } as unknown as Job;
	const operations = { identify: operation({ ended: 5, began: 1 }), place: operation(), tighten: operation(), leave: operation({ active: true }) };
	const count = (jobs: Record<string, Job>, byOrder = true): string => {
		const station = view({ by_order: byOrder, jobs, operations });
		const { done, all } = countOf(station, standingsOf(station));
		return `${done} of ${all}`;
	};
	expect(count({ '4711': job })).toBe('1 of 2');
	expect(count({ '4711': job, '4710': { ...job, state: 'ended' } })).toBe('1 of 2');
	expect(count({ '4711': job, '4712': job })).toMatch(/of 4$/);
	expect(count({}, false)).toBe('1 of 4');
});
