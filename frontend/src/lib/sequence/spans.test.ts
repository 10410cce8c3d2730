import { expect, test } from 'vitest';
import type { StationView } from '#lib/contract.ts';
import { alarm, operation, PLAN, step, view } from '#lib/testing/view.ts';
import { spansOf } from './spans.ts';

const spans = (over: Partial<StationView>, now = 100): Record<string, string[]> =>
	Object.fromEntries([...spansOf(view(over), now)].map(([name, { pieces }]) => [name, pieces.map(({ from, to, tone }) => `${tone} ${from}–${to}`)]));
const place = (over: Parameters<typeof operation>[0]): StationView['operations'] => ({ place: operation({ active: true, active_since: 90, steps: ['1', '2'], ...over }) });
const planned = (...steps: StationView['plan']['steps']): StationView['plan'] => ({ ...PLAN, steps });
const running = (expected_end: number): StationView['plan'] => planned(step('place', 'operator', 0, { id: '1', status: 'running', started: 92, expected_end }));

test('what is done lasted from its beginning to its end, with the times in which nobody worked; what nobody knows of has no span', () => {
	const work = [{ began: 12, ended: 14 }, { began: 16, ended: 20 }];
	const operations = { place: operation({ began: 10, ended: 20, work }), tighten: operation() };
	expect(spans({ operations })).toEqual({ place: ['wait 10–12', 'past 12–14', 'wait 14–16', 'past 16–20'] });
});

test('what is under way lasts to the end that is expected, or to the present where that is over', () => {
	const operations = place({ work: [{ began: 92, ended: null }] });
	expect(spans({ operations, plan: running(110) })).toEqual({ place: ['wait 90–92', 'run 92–110'] });
	expect(spans({ operations, plan: running(95) })).toEqual({ place: ['wait 90–92', 'run 92–100'] });
	const alarms = { overdue: alarm({ kind: 'overdue', subject: 'place', resources: ['operator'], since: 95 }) };
	expect(spans({ operations, plan: running(95), alarms })).toEqual({ place: ['wait 90–92', 'fail 92–100'] });
});

test('what is active waits until it is expected to be worked at, and between two steps', () => {
	const steps = [
		step('place', 'operator', 0, { id: '1', status: 'planned', expected_start: 120, expected_end: 126 }),
		step('other', 'robot', 0, { id: '7', status: 'planned', expected_start: 126, expected_end: 130 }),
		step('place', 'operator', 0, { id: '2', status: 'planned', expected_start: 130, expected_end: 133 })
	];
	expect(spans({ operations: place({}), plan: planned(...steps) })).toEqual({ place: ['wait 90–120', 'plan 120–126', 'wait 126–130', 'plan 130–133'] });
	// Late by ten seconds: all of it comes as much later.
	expect(spans({ operations: place({}), plan: planned(...steps) }, 130)).toEqual({ place: ['wait 90–130', 'plan 130–136', 'wait 136–140', 'plan 140–143'] });
	// Left out of the plan it has only waited.
	expect(spans({ operations: place({ steps: [] }) })).toEqual({ place: ['wait 90–100'] });
});

test('steps that follow on one another are one piece of work, and it is told how long it was worked and waited up to now', () => {
	const operations = place({ work: [{ began: 92, ended: 94 }, { began: 94.1, ended: null }] });
	const [span] = spansOf(view({ operations, plan: running(110) }), 100).values();
	expect(span?.pieces.map(({ tone }) => tone)).toEqual(['wait', 'past', 'run']);
	expect([span?.worked, span?.waited]).toEqual([8, 2]);
	const done = { place: operation({ began: 10, ended: 20, work: [{ began: 10, ended: 14 }, { began: 14.1, ended: 20 }] }) };
	expect(spans({ operations: done })).toEqual({ place: ['past 10–20'] });
});
