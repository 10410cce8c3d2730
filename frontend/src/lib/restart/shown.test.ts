import { describe, expect, test } from 'vitest';
import type { StationView } from '#lib/contract.ts';
import { alarm, estimate, operation, PLAN, view } from '#lib/testing/view.ts';
import { concernsRestart, leadingAlarm, passedAlarms, unconfirmed, wantedFor } from './shown.ts';

const active = operation({ active: true, active_since: 990 });

describe('the page speaks of a restart', () => {
	const cases: [string, Partial<StationView>][] = [
		['in any mode but the automatic one', { mode: 'hold' }],
		['while estimates are not confirmed', { unconfirmed: true }],
		['while outputs are not decided', { undecided: { 'robot.go': { value: true, reacts: [], reacts_messages: [], quiet: [false], unsafe: [] } } }],
		['while belief and measurement disagree', { questions: [{ variable: 'b', believed: 1, so: { id: 'as-it-was', arguments: { text: 'so' } }, possible: [2], because: [], because_messages: [] }] }],
		['when there is no plan for what is active', { plan: { ...PLAN, status: 'none' }, operations: { tighten: active } }]
	];
	test.each(cases)('%s', (_, over) => expect(concernsRestart(view(over))).toBe(true));

	test('but not while the station works by itself', () => {
		expect(concernsRestart(view())).toBe(false);
		expect(concernsRestart(view({ plan: { ...PLAN, status: 'none' } }))).toBe(false);
	});
});

test('unconfirmed are the estimates that nobody has seen since', () => {
	const belief = { writer: 'place', at: 900, evidence: [], unconfirmed_since: 950 };
	const variables = { b: estimate({ belief }), c: estimate(), 'robot.pose': estimate({ kind: 'measured', belief: null }) };
	expect(unconfirmed(variables).map(([name]) => name)).toEqual(['b']);
});

test('a station of which too little is heard is not said to be outside its safe states', () => {
	const way = { violated: [], threatened: [], differences: [], awaits: [], ticks: null, steps: [], breaks: [], reason: '', reason_message: { id: 'as-it-was', arguments: { text: '' } } };
	expect(wantedFor(view({ way_back: { ...way, awaits: ['/ur10/state'] } }))).toEqual(['unsure']);
	const violated = [{ name: 'never', title: 'Never' }];
	expect(wantedFor(view({ way_back: { ...way, violated, awaits: ['/ur10/state'] } }))).toEqual(['outside']);
	expect(wantedFor(view({ way_back: way }))).toEqual(['outside']);
});

test('what is out of service is a reason only where there is no plan without it', () => {
	const out = { of: 'resource', name: 'robot', title: 'Robot', since: 990, by: 'Eva', why: 'it squeaks', why_message: null } as const;
	expect(wantedFor(view({ out_of_service: [out] }))).toEqual([]);
	const stands = view({ out_of_service: [out], plan: { ...PLAN, status: 'none' }, operations: { tighten: active } });
	expect(wantedFor(stands)).toEqual(['noPlan', 'outOfService']);
	expect(wantedFor({ ...stands, out_of_service: [{ ...out, of: 'operation' }] })).toEqual(['noPlan']);
});

test('what a person is wanted for is not led by an alarm that is over, or that only reminds', () => {
	const over = alarm({ state: 'returned', since: 20, ended: 25 });
	const seen = alarm({ state: 'acknowledged', since: 10, ended: 15 });
	const low = alarm({ priority: 'low' });
	const leads = (rest: Partial<StationView>): (string | undefined)[] => [leadingAlarm(view(rest))?.[0], ...passedAlarms(view(rest)).map(([key]) => key)];
	expect(leads({ mode: 'hold', alarms: { over, seen, low } })).toEqual([undefined, 'over']);
	expect(leads({ mode: 'hold', alarms: { over, lasts: alarm() } })).toEqual(['lasts']);
	// Where the station works by itself it is all that there is to be said.
	expect(leads({ alarms: { over } })).toEqual(['over']);
	expect(leads({ mode: 'hold' })).toEqual([undefined]);
});
