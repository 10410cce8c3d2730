import { expect, test } from 'vitest';
import type { TriedModel, TriedMoment } from '#lib/contract.ts';
import { countAt, lanesOf, valuesAfter, type Chapter } from './runs.ts';

const moment = (seconds: number, of: Partial<TriedMoment>): TriedMoment => ({
	seconds,
	did: [],
	changes: [],
	started: [],
	ended: [],
	completed: [],
	running: [],
	active: [],
	safe: true,
	...of
});
const change = (name: string, before: string | null, after: string | null) => ({ name, before, after, so: null });
const MODEL: TriedModel = {
	before: { pose: 'home', tool: 'none' },
	running: [],
	active: [],
	safe: true,
	abilities: { 'robot.move': 'robot', 'dock.hold': 'dock' },
	titles: {},
	operations: {},
	resources: { dock: 'Dock', robot: 'Robot' },
	failing: [],
	disturbable: {}
};
const BEGUN: Chapter = { index: 0, seconds: 0, number: 1, model: MODEL };
const MOMENTS = [
	moment(0.1, { started: ['robot.move'], running: ['robot.move'] }),
	moment(2, { changes: [change('pose', 'home', 'away')], ended: ['robot.move'], started: ['dock.hold'] }),
	moment(3, { started: ['robot.move'], running: ['robot.move'] })
];

test('values are those after the moments so far, of the model that was tried then', () => {
	expect(valuesAfter([BEGUN], MOMENTS, 1)).toEqual({ pose: 'home', tool: 'none' });
	expect(valuesAfter([BEGUN], MOMENTS, 2)).toEqual({ pose: 'away', tool: 'none' });
	const edited: Chapter = { index: 2, seconds: 2.5, number: 2, model: { ...MODEL, before: { pose: 'away', gripper: 'open' } } };
	expect(valuesAfter([BEGUN, edited], MOMENTS, 3)).toEqual({ pose: 'away', gripper: 'open' });
	expect(valuesAfter([BEGUN, edited], MOMENTS, 1)).toEqual({ pose: 'home', tool: 'none' });
});

test('how many moments have been counts those at the very time', () => {
	expect([0, 0.1, 2.5, 9].map((seconds) => countAt(MOMENTS, seconds))).toEqual([0, 1, 2, 3]);
});

test('runs stand in the lanes of their resources, what is over as soon as it starts as a moment, and what is planned behind', () => {
	const plan = [{ ability: 'dock.hold', title: '', resource: 'dock', start: 3, end: 6 }];
	expect(lanesOf([BEGUN], MOMENTS, 4, plan)).toEqual([
		{
			resource: 'dock',
			runs: [
				{ ability: 'dock.hold', from: 2, to: 2, is: 'past' },
				{ ability: 'dock.hold', from: 4, to: 6, is: 'planned' }
			]
		},
		{
			resource: 'robot',
			runs: [
				{ ability: 'robot.move', from: 0.1, to: 2, is: 'past' },
				{ ability: 'robot.move', from: 3, to: 4, is: 'running' }
			]
		}
	]);
});
