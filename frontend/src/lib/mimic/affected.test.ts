import { expect, test } from 'vitest';
import type { MimicPart, MimicSymbol } from '#lib/contract.ts';
import { stoppedOf } from '#lib/operation/standing.ts';
import { alarm, estimate, operation, PLAN, step, view } from '#lib/testing/view.ts';
import { isOutside, isPartAffected, outsideOf, standsAffected } from './affected.ts';

const steps = [step('tool.run', 'tool', 1, { id: '1', status: 'running', started: 10 })];
const station = view({
	plan: { ...PLAN, steps },
	variables: {
		'bolts[pair_1]': estimate({ value: 'tight' }),
		'bolts[pair_10]': estimate({ value: 'placed' }),
		'bolts[pair_2]': estimate({ value: 'placed' }),
		'robot.pose': estimate({ value: 'pair_2' })
	},
	operations: {
		'tighten(pair_2)': operation({ active: true, active_since: 1, steps: ['1'], goal: 'old.bolts[pair_10] == tight and bolts[pair_2] == tight and bolts[pair_1] == tight' }),
		'tighten(pair_10)': operation({ active: true, active_since: 1, goal: 'bolts[pair_10] == tight' })
	},
	alarms: { overdue: alarm({ kind: 'overdue', group: 'device', priority: 'medium', resources: ['tool'], since: 20 }) },
	production: 'started'
});
const part = (variable: string): MimicPart => ({ variable }) as MimicPart;
const stop = (value: string) => ({ value, title: {}, x: 0, y: 0, label: 'none' as const, room: 0, branch: false });
const robot = { track: { position: 'robot.pose', stops: [stop('pair_1'), stop('pair_2')], ways: [], target: null } } as unknown as MimicSymbol;

test('with an operation that has stopped the part lights up that it has yet to change, and no other', () => {
	const stopped = stoppedOf(station);
	expect(stopped).toEqual({ priority: 'medium', operations: new Set(['tighten(pair_2)']) });
	const lit = (variable: string): boolean => stopped !== null && isPartAffected(part(variable), station, stopped);
	expect(['bolts[pair_1]', 'bolts[pair_2]', 'bolts[pair_10]'].map(lit)).toEqual([false, true, false]);
});

test('what stands where an operation has stopped lights up with it', () => {
	const stopped = stoppedOf(station);
	const at = (value: string): boolean =>
		stopped !== null && standsAffected(robot, { ...station, variables: { 'robot.pose': estimate({ value }) } }, stopped);
	expect([at('pair_2'), at('pair_1')]).toEqual([true, false]);
});

test('where all go on nothing lights up', () => {
	expect(stoppedOf({ ...station, alarms: {} })).toBeNull();
});

test('outside the safe states what is what it must not be lights up, and no longer once it is back', () => {
	const back = { violated: [{ name: 'never', title: 'Never' }], differences: [{ name: 'robot.pose', now: 'pair_2', safe: 'above' }] } as never;
	const outside = outsideOf(view({ way_back: back }));
	const tool = { track: null, resource: 'tool' } as unknown as MimicSymbol;
	expect([robot, tool].map((symbol) => isOutside(symbol, station, outside))).toEqual([true, false]);
	// It stands at what must not be so.
	expect(isOutside(robot, station, new Set(['bolts[pair_2]']))).toBe(true);
	expect(isOutside(robot, station, new Set(['bolts[pair_1]']))).toBe(false);
	const measured = { ...station, variables: { 'tool.runs': estimate({ resource: 'tool', value: false }) } };
	expect(isOutside(tool, measured, new Set(['tool.runs']))).toBe(true);
	expect(outsideOf(view({ way_back: null })).size).toBe(0);
});
