import { expect, test } from 'vitest';
import type { StationView } from '#lib/contract.ts';
import { PLAN, step } from '#lib/testing/view.ts';
import { awaitsOrder, doingIn, nextText, progressIn, stateText, toneOf } from './standing.ts';

test('what is most in the way is said of the station: that it stands, then what is not heard, then what needs help', () => {
	expect(stateText('working', [], [])).toBe('');
	expect(stateText('working', [], ['Robot UR10'])).toBe('Needs help: Robot UR10');
	expect(stateText('silent', ['Nutrunner'], ['Robot UR10'])).toBe('No contact: Nutrunner');
	expect(stateText('held', ['Nutrunner'], ['Robot UR10'])).toBe('Held: keep clear');
});

test('what wants help is told from what wants distance, and from what is as it should be', () => {
	expect(toneOf('working', [], [])).toBe('plain');
	for (const [silent, failing] of [[['Nutrunner'], []], [[], ['Robot UR10']]] as const)
		expect(toneOf('working', silent, failing)).toBe('medium');
	expect(toneOf('stopped', [], [])).toBe('high');
	// It looks as the alarm that names it does on the other pages.
	expect(toneOf('working', [], ['Robot UR10'], 'high')).toBe('high');
	expect(toneOf('stopped', [], [], 'medium')).toBe('medium');
	for (const standing of ['held', 'restart'] as const) expect(toneOf(standing, [], ['Robot UR10'])).toBe('medium');
	// A station that was not started, or that somebody has paused, needs nobody's help.
	for (const standing of ['waiting', 'preparing', 'paused'] as const) expect(toneOf(standing, ['Robot UR10'], [])).toBe('plain');
});

test('what comes next is told with about when, as far as that is known', () => {
	const next = { title: 'Place bolts', at: 108 };
	expect(nextText(null, 100)).toBe('');
	expect(nextText(undefined, null)).toBe('');
	expect(nextText(next, 100)).toBe('Place bolts in\u00a0about\u00a08\u00a0s');
	expect(nextText(next, -25)).toBe('Place bolts in\u00a0about\u00a02\u00a0min');
	// What was expected and has not come yet still comes.
	expect(nextText(next, 120)).toBe('Place bolts soon');
	expect(nextText({ ...next, at: null }, 100)).toBe('Next: Place bolts');
});

test('how far the station is: of the order in work, or of the operations since the first of them began', () => {
	const operation = (active: boolean, began: number | null, ended: number | null): object => ({ active, active_since: active ? began : null, began, ended });
	const of = (jobs: object, operations: object[], byOrder = false): unknown =>
		progressIn({ jobs, operations: { ...operations }, by_order: byOrder } as unknown as Parameters<typeof progressIn>[0]);
	const steps = { a: { state: 'completed' }, b: { state: 'skipped' }, c: { state: 'active' } };
	expect(of({ one: { state: 'running', steps } }, [])).toEqual({ done: 1, all: 2 });
	expect(of({ one: { state: 'ended', steps } }, [operation(false, 1, 2)], true)).toBeNull();
	// What was completed before this round is not done in it.
	expect(of({}, [operation(false, 10, 12), operation(false, 5, 8), operation(true, 12, 9)])).toEqual({ done: 1, all: 3 });
	expect(of({}, [])).toBeNull();
});

test('that the station waits for an order is said where it could make one, and none may start', () => {
	const free = { by_order: true, standing: 'working', jobs: {} } as const;
	const job = (state: string): StationView['jobs'] => ({ a: { state, ended: state === 'ended' ? 5 : null } as StationView['jobs'][string] });
	expect(awaitsOrder(free)).toBe(true);
	expect(awaitsOrder({ ...free, jobs: job('ended') })).toBe(true);
	expect(awaitsOrder({ ...free, jobs: job('waiting') })).toBe(false);
	expect(awaitsOrder({ ...free, jobs: job('paused') })).toBe(false);
	expect(awaitsOrder({ ...free, standing: 'held' })).toBe(false);
	expect(awaitsOrder({ ...free, by_order: false })).toBe(false);
});

test('what devices do is told, and not what people do or what may be so', () => {
	const steps = [step('robot.move', 'robot', 0, { status: 'running' }), step('operator.place', 'operator', 0, { status: 'running' }), step('robot.wait', 'robot', 1)];
	const abilities = { 'robot.move': { human: false }, 'operator.place': { human: true } } as unknown as StationView['abilities'];
	const now: Parameters<typeof doingIn>[0] = { plan: { ...PLAN, steps }, abilities, standing: 'working', failing: [] };
	expect(doingIn(now).map((each) => (each as { ability?: string }).ability)).toEqual([steps[0]?.ability]);
	expect(doingIn({ ...now, failing: ['Robot'] })).toEqual([]);
	expect(doingIn({ ...now, standing: 'silent' })).toEqual([]);
});
