import { describe, expect, test } from 'vitest';
import type { JobOrder, OrderOfWork } from '#lib/contract.ts';
import { view as viewOf } from '#lib/testing/view.ts';
import { inOrder, lateOf, progressOf, secondsOf, titleOf } from './orders.ts';

function order(id: string, rest: Partial<JobOrder> = {}): JobOrder {
	return {
		id,
		work_master: 'truck_engine',
		description: '',
		priority: 0,
		due: null,
		due_at: null,
		earliest: null,
		earliest_at: null,
		state: 'AllowedToStart',
		commanded: null,
		allowed: [],
		revision: 1,
		stored: 0,
		stored_at: '1970-01-01T00:00:00Z',
		stored_by: 'MES',
		changed: 0,
		changed_at: '1970-01-01T00:00:00Z',
		began: null,
		began_at: null,
		ended: null,
		ended_at: null,
		waits_for: [],
		waits_for_messages: [],
		sentence: null,
		...rest
	};
}

const FOUND: OrderOfWork = {
	time: 1,
	time_at: '1970-01-01T00:00:01Z',
	job_orders: [
		{ id: 'c', late: 12, operations: [] },
		{ id: 'a', late: 0, operations: [] }
	],
	tardiness: 12,
	bound: 12,
	optimal: true,
	horizon: 2,
	fallback: ''
};

describe('orders are listed', () => {
	const ids = (orders: readonly JobOrder[], found: OrderOfWork | null): string => inOrder(orders, found).map(({ id }) => id).join(' ');

	test('those that are worked on first, then as they are to begin', () => {
		const orders = [order('a'), order('b', { state: 'Running' }), order('c'), order('d', { state: 'NotAllowedToStart', priority: 9 })];
		expect(ids(orders, FOUND)).toBe('b c a d');
	});

	test('once, as it was last, though two lists have it', () => {
		const orders = [order('a', { state: 'Running', revision: 3 }), order('a', { revision: 2 }), order('b')];
		expect(inOrder(orders, null).map(({ id, state }) => `${id} ${state}`)).toEqual(['a Running', 'b AllowedToStart']);
	});

	test('by priority, time and age where no order of work was found', () => {
		const orders = [order('late', { due: 20 }), order('old'), order('soon', { due: 10 }), order('urgent', { priority: 5 }), order('new', { stored: 9 })];
		expect(ids(orders, null)).toBe('urgent soon late old new');
	});
});

test('an order without a description is called by its id', () => {
	expect(titleOf(order('e-1', { description: '  ' }))).toBe('e-1');
	expect(titleOf(order('e-1', { description: 'Engine 1' }))).toBe('Engine 1');
});

test('how late an order is expected to be', () => {
	expect(lateOf(FOUND, 'c')).toBe(12);
	expect(lateOf(FOUND, 'x')).toBe(0);
	expect(lateOf(null, 'c')).toBe(0);
});

test('how far an order has come is told by its job', () => {
	const step = { waits_for: [], started: null, ended: null };
	const job = {
		title: 'e-1',
		work_master: 'truck_engine',
		state: 'running' as const,
		stopping: false,
		taken: 0,
		begun: 0,
		ended: null,
		waits_for: [],
		waits_for_messages: [],
		sentence: null,
		steps: {
			place: { ...step, state: 'completed' as const },
			tighten: { ...step, state: 'active' as const },
			repair: { ...step, state: 'skipped' as const }
		}
	};
	expect(progressOf(viewOf({ jobs: { 'e-1': job } }), 'e-1')).toEqual({ done: 1, all: 2, active: ['tighten'] });
	expect(progressOf(viewOf({}), 'e-1')).toBeNull();
	expect(progressOf(null, 'e-1')).toBeNull();
});

test('a local time means the moment that it names here', () => {
	expect(secondsOf('2026-11-22T12:30')).toBe(new Date(2026, 10, 22, 12, 30).getTime() / 1000);
	expect(secondsOf('')).toBeNull();
});
