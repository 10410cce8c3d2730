import { expect, test } from 'vitest';
import type { Job, StationView } from '#lib/contract.ts';
import { alarm, operation, PLAN, step, view } from '#lib/testing/view.ts';
import { isAtWork, standingsOf, standstillTone, stoppedTone, underWay } from './standing.ts';

const standings = (over: Partial<StationView>): Record<string, string> => Object.fromEntries(standingsOf(view(over)));

test('a round begins with the first operation: what was done before it is to be done again', () => {
	const done = { began: 10, ended: 20 };
	const before = { identify: operation({ began: 0, ended: 5 }), place: operation(done), leave: operation() };
	expect(standings({ operations: before })).toEqual({ identify: 'done', place: 'done', leave: 'waits' });
	const again = { ...before, identify: operation({ ...done, active: true, active_since: 30 }), leave: operation({ began: 20, ended: 25 }) };
	expect(standings({ operations: again })).toEqual({ identify: 'active', place: 'waits', leave: 'waits' });
	const later = { ...again, identify: operation({ began: 30, ended: 31 }), leave: operation({ began: 32, ended: 33 }) };
	expect(standings({ operations: later })).toEqual({ identify: 'done', place: 'waits', leave: 'done' });
});

test('by order it is the job that says what is done', () => {
	const state = (state: Job['steps'][string]['state']): Job['steps'][string] => ({ state, waits_for: [], started: null, ended: null });
	const steps = { place: state('completed'), tighten: state('skipped'), leave: state('waiting') };
	const jobs = { '4711': { title: 'Engine', steps } as unknown as Job };
	const ordered = operation({ for_jobs: true, job: '4711', began: 10, ended: 20 });
	expect(standings({ by_order: true, jobs, operations: { place: ordered, tighten: ordered, leave: ordered } })).toEqual({
		place: 'done',
		tighten: 'done',
		leave: 'waits'
	});
});

test('by order nothing is done of a product that no job asks for', () => {
	const ordered = operation({ for_jobs: true, job: null, began: 10, ended: 20 });
	const found = standings({ by_order: true, jobs: {}, operations: { place: ordered, take: operation({ began: 10, ended: 20 }) } });
	expect(found).toEqual({ place: 'waits', take: 'waits' });
});

test('one of which a step comes to no end has stopped, until that is over', () => {
	const steps = [step('run', 'nutrunner', 0, { id: '7', status: 'running', started: 100 })];
	const of = { active: true, active_since: 90 };
	const operations = {
		tighten: operation({ ...of, steps: ['6', '7', '8'] }),
		place: operation({ ...of, steps: ['9'] })
	};
	const overdue = alarm({ kind: 'overdue', subject: 'run', resources: ['nutrunner'], since: 140 });
	const at = (each: ReturnType<typeof alarm>): Record<string, string> =>
		standings({ operations, plan: { ...PLAN, steps }, alarms: { overdue: each } });
	expect(at(overdue)).toEqual({ tighten: 'stopped', place: 'active' });
	expect(at({ ...overdue, ended: 150 })).toEqual({ tighten: 'active', place: 'active' });
	expect(at({ ...overdue, since: 99 })).toEqual({ tighten: 'active', place: 'active' });
	// Of what is not heard nobody knows how far it is.
	expect(at({ ...overdue, kind: 'silent' })).toEqual({ tighten: 'stopped', place: 'active' });
	// A newer plan has other steps for what is worked on.
	const worked = { ...operations, tighten: operation({ ...of, steps: ['8'], work: [{ began: 95, ended: null }] }) };
	expect(standings({ operations: worked, plan: { ...PLAN, steps }, alarms: { overdue } })).toEqual({ tighten: 'stopped', place: 'active' });
	// It is as urgent as the alarm that says so.
	const tone = (priority: 'high' | 'medium'): string | null => stoppedTone(view({ plan: { ...PLAN, steps }, alarms: { overdue: { ...overdue, priority } } }));
	expect([tone('medium'), tone('high'), stoppedTone(view())]).toEqual(['medium', 'high', null]);
});

test('without a plan nothing goes on but what runs at devices that are heard', () => {
	const steps = [step('run', 'nutrunner', 0, { id: '7', status: 'running', started: 100 })];
	const operations = { tighten: operation({ active: true, steps: ['7'] }), place: operation({ active: true }) };
	const plan = { ...PLAN, status: 'none' as const, steps };
	expect(standings({ operations, plan })).toEqual({ tighten: 'active', place: 'stopped' });
	expect(standings({ operations, plan: { ...plan, status: 'planning' } })).toEqual({ tighten: 'active', place: 'active' });
	const silent = alarm({ resources: ['nutrunner'], priority: 'medium' });
	expect(standings({ operations, plan, alarms: { silent } })).toEqual({ tighten: 'stopped', place: 'stopped' });
	expect([standstillTone(view({ alarms: { silent } })), standstillTone(view({ alarms: { silent: { ...silent, ended: 200 } } }))]).toEqual(['medium', null]);
});

test('of several of a kind those at which somebody is at work are under way, or else the first', () => {
	const active = operation({ active: true });
	const worked = operation({ active: true, work: [{ began: 1, ended: null }] });
	const under = (operations: StationView['operations']): string[] => [...underWay(view({ operations }))];
	expect(under({ 'place(1)': active, 'place(2)': worked, take: active, leave: operation() })).toEqual(['place(2)', 'take']);
	expect(under({ 'place(1)': active, 'place(2)': active })).toEqual(['place(1)']);
});

test('of several that are under way it is told at which somebody is at work', () => {
	const at = (ended: number | null, active = true): boolean => isAtWork(operation({ active, work: [{ began: 1, ended: 2 }, { began: 3, ended }] }));
	expect([at(null), at(4), at(null, false), isAtWork(operation({ active: true }))]).toEqual([true, false, false, false]);
});
