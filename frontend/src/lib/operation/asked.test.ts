import { expect, test } from 'vitest';
import type { Job, Operation, StationView } from '#lib/contract.ts';
import { view } from '#lib/testing/view.ts';
import { askedFor, severalOrders } from './asked.ts';

type StepState = Job['steps'][string]['state'];

const operation = { for_jobs: true, job: '4711' } as Operation;

function asked(over: Partial<Operation> = {}, state: StepState = 'waiting', by_order = true, of: Job['state'] = 'running'): unknown {
	const steps = { tighten: { state, waits_for: [], started: null, ended: null } };
	const jobs: StationView['jobs'] = { '4711': { title: 'Engine', steps, state: of } as unknown as Job };
	return askedFor(view({ by_order, jobs, operations: { tighten: { ...operation, ...over } } }), 'tighten');
}

test('an operation of a job says whether it is its turn', () => {
	expect(asked()).toEqual({ how: 'later', job: 'Engine' });
	expect(asked({}, 'eligible')).toEqual({ how: 'now', job: 'Engine' });
	expect(asked({}, 'active')).toEqual({ how: 'now', job: 'Engine' });
	expect(asked({}, 'completed')).toEqual({ how: 'done', job: 'Engine' });
	expect(asked({}, 'skipped')).toEqual({ how: 'skipped', job: 'Engine' });
});

test('of a job that is paused nothing is its turn', () => {
	expect(asked({}, 'waiting', true, 'paused')).toEqual({ how: 'paused', job: 'Engine' });
	expect(asked({}, 'eligible', true, 'paused')).toEqual({ how: 'paused', job: 'Engine' });
	expect(asked({}, 'completed', true, 'paused')).toEqual({ how: 'done', job: 'Engine' });
});

test('whose it is is told where several orders are under way', () => {
	const job = (ended: number | null): Job => ({ ended }) as Job;
	expect(severalOrders({ jobs: { a: job(null), b: job(5) } })).toBe(false);
	expect(severalOrders({ jobs: { a: job(null), b: job(null) } })).toBe(true);
});

test('without a job it says so, and where none is needed it says nothing', () => {
	expect(asked({ job: null })).toEqual({ how: 'none', job: '' });
	expect(asked({ for_jobs: false, job: null })).toBeNull();
	expect(asked({}, 'waiting', false)).toBeNull();
	expect(askedFor(null, 'tighten')).toBeNull();
});
