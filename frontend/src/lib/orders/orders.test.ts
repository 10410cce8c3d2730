import { describe, expect, test } from 'vitest';
import type { JobOrder, JobResponse, OrderOfWork } from '#lib/contract.ts';
import { operation, view as viewOf } from '#lib/testing/view.ts';
import { lastParts, lineOf, ownWords, partFor } from './line.ts';
import { actsOf, inOrder, isOfDay, lastEnd, lateBy, lateText, nameOf, overOf, progressOf, secondsOf, standing, titleOf, untimed, waitsText, wasLateBy } from './orders.ts';

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
		expected_start: null,
		expected_start_at: null,
		expected_end: null,
		expected_end_at: null,
		reason: null,
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

test('an order is called by its number, and by its description where nobody has given it one', () => {
	const drawn = '00f1a2b3c4d5e6f7';
	expect(titleOf(order('D13-4711', { description: 'Engine D13K 540' }))).toBe('D13-4711');
	expect(titleOf(order(drawn, { description: ' Engine D13K 540 ' }))).toBe('Engine D13K 540 · e6f7');
	expect(titleOf(order(drawn, { description: '  ' }))).toBe('e6f7');
});

test('a card has the number as its title and the description below it, and no word twice', () => {
	const drawn = '00f1a2b3c4d5e6f7';
	expect(nameOf(order('D13-4711', { description: 'Engine D13K 540' }))).toEqual({ name: 'D13-4711', mark: '', said: 'Engine D13K 540' });
	expect(nameOf(order('D13-4711', { description: 'D13-4711' }))).toEqual({ name: 'D13-4711', mark: '', said: '' });
	expect(nameOf(order(drawn, { description: 'Engine D13K 540' }))).toEqual({ name: 'Engine D13K 540', mark: 'e6f7', said: '' });
});

describe('how late an order is', () => {
	test('is told by when it is expected to be ready', () => {
		expect(lateBy(order('a', { due: 100, expected_end: 160 }), 50)).toBe(60);
		expect(lateBy(order('a', { due: 200, expected_end: 160 }), 50)).toBe(0);
		expect(lateBy(order('a', { expected_end: 160 }), 50)).toBe(0);
	});

	test('is at least how long it should have been ready', () => {
		expect(lateBy(order('a', { due: 100 }), 130)).toBe(30);
		expect(lateBy(order('a', { due: 100, expected_end: 90 }), 130)).toBe(30);
		expect(lateBy(order('a', { due: 100 }), 50)).toBe(0);
	});
});

test('by how much it is late is told in whole minutes, and never as more than it is', () => {
	expect([0, 0.4, 20, 59, 60, 119, 3600].map(lateText)).toEqual(['', '', 'under 1 min late', 'under 1 min late', '1 min late', '1 min late', '60 min late']);
	expect(lateText(3 * 3600)).toContain('3 h');
});

test('what is over is told with what was late and why, the last first; what was taken away among it', () => {
	const made = { job_order: 'm', work_master: 'engine', description: '', began: 10, due: 150, reason: null } as JobResponse;
	const responses = [
		{ ...made, outcome: 'completed', ended: 200 },
		{ ...made, job_order: 'x', outcome: 'aborted', ended: 300, reason: 'no parts' }
	] as JobResponse[];
	const over = overOf(responses, [order('c', { changed: 250, reason: 'ordered twice' })]);
	expect(over.map(({ id, outcome, reason, response }) => [id, outcome, reason, response !== null])).toEqual([
		['x', 'aborted', 'no parts', true],
		['c', 'cancelled', 'ordered twice', false],
		['m', 'completed', null, true]
	]);
	expect(over.map(wasLateBy)).toEqual([0, 0, 50]);
});

test('while the station stands no order has a time at which it begins or is ready', () => {
	const orders = untimed([order('a', { began: 5, expected_end: 20 }), order('b', { expected_start: 20, expected_end: 30 })]);
	expect(lastEnd(orders)).toBeNull();
	expect(lineOf(orders, [], 10)).toMatchObject({ unknown: 1 });
});

test('when all are ready is said only where it is known of each', () => {
	expect(lastEnd([order('a', { expected_end: 10 }), order('b', { expected_end: 30 })])).toBe(30);
	expect(lastEnd([order('a', { expected_end: 10 }), order('b')])).toBeNull();
	expect(lastEnd([])).toBeNull();
});

test('each order stands in the column of its state', () => {
	const orders = [order('a', { state: 'Running' }), order('b', { state: 'Interrupted' }), order('c'), order('d', { state: 'NotAllowedToStart' })];
	const ids = (stand: 'stored' | 'waiting' | 'worked'): string => standing(orders, stand).map(({ id }) => id).join(' ');
	expect([ids('stored'), ids('waiting'), ids('worked')]).toEqual(['d', 'c', 'a b']);
});

test('all that an order allows can be done, one act at once', () => {
	expect(actsOf({ allowed: ['Stop', 'Pause', 'Abort'] })).toEqual({ first: 'Pause', rest: ['Stop', 'Abort'] });
	expect(actsOf({ allowed: ['RevokeStart', 'Abort', 'Cancel'] })).toEqual({ first: null, rest: ['RevokeStart', 'Abort', 'Cancel'] });
});

test('what was made today was made since midnight here', () => {
	const noon = new Date(2026, 10, 22, 12).getTime() / 1000;
	expect(isOfDay(noon - 11.9 * 3600, noon)).toBe(true);
	expect(isOfDay(noon - 12.1 * 3600, noon)).toBe(false);
});

describe('the order of work over time', () => {
	const made: JobResponse = {
		number: 1,
		job_order: 'm',
		work_master: 'truck_engine',
		description: 'Made',
		outcome: 'completed',
		due: null,
		due_at: null,
		reason: null,
		began: 100,
		began_at: null,
		ended: 200,
		ended_at: '',
		operations: [],
		abilities: [],
		deviations: [],
		deviations_left_out: 0,
		corrections: []
	};

	test('has what was made, what is in work and what is expected, by work master', () => {
		const orders = [
			order('run', { state: 'Running', began: 210, expected_end: 400 }),
			order('next', { expected_start: 400, expected_end: 500, due: 450 }),
			order('then', { expected_start: 500, expected_end: 600, due: 900 }),
			order('pump', { work_master: 'pump', expected_start: 300, expected_end: 350 })
		];
		const { lanes, due, unknown } = lineOf(orders, [made, { ...made, job_order: 'never', began: null }], 300);
		const bars = [...lanes].map(([name, all]) => `${name}: ${all.map(({ id, tone, from, to }) => `${id} ${tone} ${from}-${to}`).join(', ')}`);
		expect(bars).toEqual(['truck_engine: m past 100-200, run run 210-400, next next 400-500, then plan 500-600', 'pump: pump plan 300-350']);
		expect(due.map(({ id, at, late }) => `${id} ${at} ${late}`)).toEqual(['next 450 true', 'then 900 false']);
		expect(unknown).toBe(0);
	});

	test('draws nothing of which nobody knows', () => {
		const orders = [order('run', { state: 'Running', began: 210 }), order('a'), order('b', { expected_start: 900 }), order('c', { state: 'NotAllowedToStart' })];
		const { lanes, unknown } = lineOf(orders, [], 300);
		expect(lanes.get('truck_engine')).toMatchObject([{ id: 'run', from: 210, to: 300, open: true }]);
		expect(unknown).toBe(2);
	});

	test('shows as much as leaves a usual order wide enough', () => {
		const parts = [600, 1800, 7200];
		const lasting = (...seconds: number[]): number =>
			partFor(lineOf([], seconds.map((each) => ({ ...made, began: 100, ended: 100 + each })), 300), parts);
		expect([lasting(20, 20, 900), lasting(60), lasting(600), lasting(5), lasting()]).toEqual([600, 1800, 7200, 600, 7200]);
	});
});

test('what an order waits for is a sentence, and in short the first of it', () => {
	const waiting = (...reasons: string[]): Parameters<typeof waitsText>[0] => ({ waits_for: reasons, waits_for_messages: [], sentence: null });
	expect([waitsText(waiting()), waitsText(waiting('a plan'), true)]).toEqual(['', 'Waits: a plan']);
	expect(waitsText(waiting('a plan', 'control'))).toBe('Waits: a plan; control');
	expect(waitsText(waiting('a plan', 'control'), true)).toBe('Waits: a plan +1');
});

test('of an operation that waits it is said in short until when', () => {
	const waits = (...operations: string[]): Parameters<typeof waitsText>[0] => ({
		waits_for: operations.map((each) => `“${each}”, which waits until the frame is on the engine`),
		waits_for_messages: operations.map((operation) => ({
			id: 'waits.precondition',
			arguments: { operation, condition: { words: { en: 'the frame is on the engine' }, written: 'frame == on_engine' } }
		})),
		sentence: null
	});
	expect(waitsText(waits('Place pair 1', 'Place pair 2'), true)).toBe('Waits until the frame is on the engine');
	expect(waitsText(waits('Place pair 1'))).toBe('Waits: “Place pair 1”, which waits until the frame is on the engine');
});

const JOB = {
	title: 'e-1',
	work_master: 'truck_engine',
	state: 'running' as const,
	stopping: false,
	taken: 0,
	begun: 0,
	ended: null,
	waits_for: [],
	waits_for_messages: [],
	sentence: null
};

test('how far an order has come is told by its job', () => {
	const step = { waits_for: [], started: null, ended: null };
	const job = {
		...JOB,
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

test('operations that differ in a parameter alone are told as one', () => {
	const step = { waits_for: [], started: null, ended: null, state: 'active' as const };
	const job = { ...JOB, steps: { 'tighten(1)': step, 'tighten(2)': step, unknown: step } };
	const operations = { 'tighten(1)': operation({ title: 'Tighten pair 1' }), 'tighten(2)': operation({ title: 'Tighten pair 2' }) };
	expect(progressOf(viewOf({ jobs: { 'e-1': job }, operations }), 'e-1')?.active).toEqual(['Tighten pair 1–2', 'unknown']);
});

test('a bar says what is its own', () => {
	expect(ownWords(['Engine D13-4711', 'Engine D11-0288'])).toEqual(['D13-4711', 'D11-0288']);
	expect(ownWords(['Engine', 'Engine D11-0288'])).toEqual(['Engine', 'Engine D11-0288']);
	expect(ownWords(['Engine D13-4711'])).toEqual(['Engine D13-4711']);
	expect(ownWords([])).toEqual([]);
	expect(ownWords(['D13-4711', 'D13-4712']), 'parts of a number').toEqual(['4711', '4712']);
	expect(ownWords(['Engine D13K 540 · a1b2', 'Engine D13K 540 · c3d4'])).toEqual(['a1b2', 'c3d4']);
});

test('a bar with little room has the end of the number, unless two have the same', () => {
	expect(lastParts(['D13-4711', 'D11-0288'])).toEqual(['4711', '0288']);
	expect(lastParts(['D13-4711', 'D13-4711'])).toEqual(['4711', '4711']);
	expect(lastParts(['D13-4711', 'D11-4711'])).toEqual(['D13-4711', 'D11-4711']);
	expect(lastParts(['Engine · a1b2', 'D13-4711'])).toEqual(['a1b2', '4711']);
});

test('a local time means the moment that it names here', () => {
	expect(secondsOf('2026-11-22T12:30')).toBe(new Date(2026, 10, 22, 12, 30).getTime() / 1000);
	expect(secondsOf('')).toBeNull();
});
