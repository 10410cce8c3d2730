import { expect, test } from 'vitest';
import type { Past } from '#lib/contract.ts';
import { stoppedOf } from '#lib/operation/standing.ts';
import { alarm, estimate, operation, task, view } from '#lib/testing/view.ts';
import { pastView } from './past-view.ts';

const past: Past = {
	tick: 5,
	revision: 2,
	mode: 'hold',
	packml: 'held',
	production: 'started',
	stepping: false,
	values: { bolts: 'empty' },
	running: ['robot.move'],
	active: ['place'],
	by_order: true,
	jobs: {},
	plan: { status: 'idle', reason: '', reason_message: { id: 'as-it-was', arguments: { text: '' } }, steps: [] },
	errand: null,
	forces: {},
	out_of_service: []
};
const ability = {
	resource: 'robot',
	title: 'Move',
	human: false,
	restart: false,
	moves: true,
	enabled: true,
	executing: false,
	finished: false,
	running_since: 990
};
const now = view({
	variables: { bolts: estimate({ value: 'placed' }), lamp: estimate({ value: 'on' }) },
	abilities: { 'robot.move': ability, 'robot.wait': { ...ability, executing: true } },
	resources: { robot: { title: 'Robot', online: false, awaited_topics: ['/robot'] } },
	alarms: { a: alarm() },
	tasks: { t: task(1) }
});

test('the station as it was has nothing of what is so now', () => {
	const then = pastView(now, past);
	expect(then.variables['bolts']?.value).toBe('empty');
	expect(then.variables['lamp']?.value, 'which was not there then').toBeNull();
	expect([then.abilities['robot.move']?.executing, then.abilities['robot.wait']?.executing]).toEqual([true, false]);
	expect(then.abilities['robot.move']?.running_since).toBeNull();
	expect([then.mode, then.packml, then.by_order]).toEqual(['hold', 'held', true]);
	expect([then.alarms, then.tasks, then.resources['robot']?.online]).toEqual([{}, {}, true]);
	expect(now.variables['bolts']?.value, 'the present stays as it is').toBe('placed');
});

test('what stood then is seen, and what stands now is not', () => {
	const then = pastView(now, past, { b: alarm({ text: 'The robot stands still' }) });
	expect(Object.keys(then.alarms)).toEqual(['b']);
});

test('what had come to a stop then is known from its plan and its alarms', () => {
	type Step = Past['plan']['steps'][number];
	const running: Step = { ability: 'robot.move', title: 'Move', status: 'running', tick: 1, started: 900, ended: null, called_off: false, operations: ['place'] };
	const other: Step = { ...running, ability: 'robot.wait', status: 'next', started: null, operations: ['wait'] };
	const working: Past = { ...past, mode: 'automatic', active: ['place', 'wait'], plan: { ...past.plan, status: 'followed', steps: [running, other] } };
	const here = { ...now, operations: { place: operation(), wait: operation() }, plan: { ...now.plan, steps: [] } };
	const stuck = alarm({ kind: 'overdue', group: 'device', resources: ['robot'], since: 950, priority: 'medium' });
	const stopped = stoppedOf(pastView(here, working, { 'overdue:robot.move': stuck }));
	expect([stopped?.priority, [...(stopped?.operations ?? [])]]).toEqual(['medium', ['place']]);
	expect(stoppedOf(pastView(here, working))).toBeNull();
});
