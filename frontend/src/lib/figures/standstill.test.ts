import { expect, test } from 'vitest';
import type { Ability, StationView } from '#lib/contract.ts';
import { alarm, operation, PLAN, step, view } from '#lib/testing/view.ts';
import { standstillOf } from './standstill.ts';

const NOW = 1000;
const run = step('nutrunner.run', 'nutrunner', 0, { status: 'running', started: 990, expected_end: 993 });
const move = step('robot.move', 'robot', 0, { status: 'running', started: 990, expected_end: 995 });
const place = step('operator.place', 'operator', 0, { status: 'running', started: 980, expected_end: 985 });
const late = alarm({ kind: 'overdue', since: 995, resources: ['nutrunner'] });
const told = (steps: StationView['plan']['steps'], rest: Partial<StationView> = {}): string | null =>
	standstillOf(view({ production: 'started', plan: { ...PLAN, steps }, abilities: { 'operator.place': { human: true } as Ability }, ...rest }), NOW);

test('the station is stopped when all that runs is, and no sooner', () => {
	const alarms = { 'overdue:nutrunner.run': late };
	expect(told([run])).toBeNull();
	expect(told([run], { alarms })).toBe('stopped');
	expect(told([run, move], { alarms }), 'the robot goes on').toBeNull();
	expect(told([run, place], { alarms }), 'the person is waited for as well').toBe('stopped');
	expect(told([run], { alarms: { 'overdue:nutrunner.run': { ...late, ended: 999 } } })).toBeNull();
	expect(told([run], { alarms: { 'silent:nutrunner': alarm({ kind: 'silent', since: 900, resources: ['nutrunner'] }) } })).toBe('stopped');
	expect(told([run], { standing: 'stopped' })).toBe('stopped');
});

test('without a plan it is stopped where something is to be done', () => {
	const plan = { ...PLAN, status: 'none' as const, steps: [] };
	expect(told([], { plan, operations: { place: operation({ active: true }) } })).toBe('stopped');
	expect(told([], { plan, operations: { place: operation() } })).toBeNull();
});

test('it waits for a person who takes longer than people do, and in a mode in which nothing starts', () => {
	expect(told([place])).toBe('waits');
	expect(told([{ ...place, started: 985, expected_end: 990 }]), 'a bit longer is usual').toBeNull();
	expect(told([run], { mode: 'hold' })).toBe('waits');
	expect(told([run], { production: 'waiting', mode: 'hold' })).toBeNull();
	expect(standstillOf(null, NOW)).toBeNull();
});
