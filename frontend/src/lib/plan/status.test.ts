import { expect, test } from 'vitest';
import type { Ability, Job, Operation } from '#lib/contract.ts';
import { alarm, PLAN, step, view } from '#lib/testing/view.ts';
import { awaited, isOfNoPlan, isUnheard, nothingNext, spanFor, standsSince, stoppedBy } from './status.ts';

const active = { active: true } as Operation;
const idle = { ...PLAN, status: 'idle' as const };
const running = [step('run', 'nutrunner', 0, { status: 'running', started: 990 })];

test.each([
	['production', view({ production: 'waiting', plan: idle, operations: { a: active } })],
	['paused', view({ mode: 'hold', plan: idle })],
	['waits', view({ plan: { ...PLAN, steps: running } })],
	['followed', view()],
	['planning', view({ plan: idle, operations: { a: active } })],
	['idle', view({ plan: idle, operations: { a: { ...active, active: false } } })],
	['order', view({ plan: idle, jobs: { a: { state: 'paused' } as Job } })],
	['noOrder', view({ plan: idle, by_order: true })],
	['noOrder', view({ plan: idle, by_order: true, jobs: { a: { state: 'ended', ended: 5 } as Job } })],
	['none', view({ mode: 'restart', plan: { ...PLAN, status: 'none' } })]
])('no next start is said as %s, and never as nothing to plan while something is active', (said, station) => {
	expect(nothingNext(station)).toBe(said);
});

test('a step runs unheard while an alarm tells that its device is silent, and no longer', () => {
	const [run] = running;
	const silent = alarm({ kind: 'silent', resources: ['nutrunner'] });
	expect(run && isUnheard(run, { a: silent })).toBe(true);
	expect(run && isUnheard(run, { a: { ...silent, kind: 'many-silent', resources: ['robot', 'nutrunner'] } })).toBe(true);
	expect(run && isUnheard(run, { a: { ...silent, ended: 995 } })).toBe(false);
	expect(run && isUnheard(run, { a: { ...silent, resources: ['robot'] } })).toBe(false);
	expect(run && isUnheard(run, { a: { ...silent, kind: 'overdue' } })).toBe(false);
	expect(isUnheard(step('run', 'nutrunner', 0, { status: 'next' }), { a: silent })).toBe(false);
});

test('an alarm tells that there is no plan by itself, as what it means, or among what comes of its cause', () => {
	const parts = [{ id: 'no-plan.text', arguments: {} }];
	expect(isOfNoPlan(alarm({ kind: 'no-plan' }))).toBe(true);
	expect(isOfNoPlan(alarm({ messages: { ...alarm().messages, parts } }))).toBe(true);
	const means = { id: 'wait.no-plan', arguments: { count: 1, rest: '' } };
	const consequence = { id: 'silent.consequence', arguments: { consequence: means } };
	expect(isOfNoPlan(alarm({ messages: { ...alarm().messages, consequence } }))).toBe(true);
	expect(isOfNoPlan(alarm())).toBe(false);
});

test('a plan waits for people while nothing else runs and their tasks take longer than expected', () => {
	const task = step('operator.place', 'operator', 0, { status: 'running', started: 980, expected_end: 995 });
	const abilities = { 'operator.place': { human: true } as Ability, 'robot.move': { human: false } as Ability };
	expect(awaited({ plan: { ...PLAN, steps: [task] }, abilities }, 994)).toEqual([]);
	expect(awaited({ plan: { ...PLAN, steps: [task] }, abilities }, 996)).toEqual(['operator']);
	const move = step('robot.move', 'robot', 0, { status: 'running', started: 990, expected_end: 995 });
	expect(awaited({ plan: { ...PLAN, steps: [task, move] }, abilities }, 996)).toEqual([]);
	expect(awaited({ plan: { ...PLAN, steps: [] }, abilities }, 996)).toEqual([]);
});

test('each of two runs of a device has stopped that has an alarm of its own, and else the last one', () => {
	const first = step('tool.float', 'tool', 0, { status: 'running', started: 980 });
	const last = step('tool.run', 'tool', 0, { status: 'running', started: 985 });
	const late = alarm({ kind: 'overdue', group: 'device', priority: 'medium', resources: ['tool'], since: 990 });
	const stopped = (alarms: Parameters<typeof stoppedBy>[2]) => [first, last].map((each) => stoppedBy(each, [first, last], alarms));
	expect(stopped({ 'overdue:tool.run': late })).toEqual([null, 'medium']);
	expect(stopped({ 'overdue:tool.run': late, 'overdue:tool.float': late })).toEqual(['medium', 'medium']);
	expect(stopped({ 'overdue:tool.float': { ...late, ended: 992 } })).toEqual([null, null]);
});

test('with a run that does not go on its start is in sight, and a little of what came before it', () => {
	const silent = alarm({ kind: 'silent', resources: ['nutrunner'] });
	expect(standsSince({ steps: running }, {})).toBeNull();
	expect(standsSince({ steps: running }, { silent })).toBe(990);
	const spans = [20, 45, 120, 0];
	expect([spanFor(5, spans), spanFor(9.5, spans), spanFor(30, spans), spanFor(500, spans)]).toEqual([20, 45, 0, 0]);
});

test('a run that was over before the alarm came is none of those that it tells of', () => {
	const run = { id: '1', status: 'done' as const, started: 100 };
	const steps = [step('run', 'nutrunner', 0, { ...run, ended: 102 }), step('run', 'nutrunner', 1, { ...run, id: '2', started: 110, ended: 140 })];
	const alarms = { 'overdue:run': alarm({ kind: 'overdue', subject: 'run', priority: 'medium', resources: ['nutrunner'], since: 115 }) };
	expect(steps.map((each) => stoppedBy(each, steps, alarms))).toEqual([null, 'medium']);
});
