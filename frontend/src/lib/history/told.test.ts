import { expect, test } from 'vitest';
import { namesOf } from './names.ts';
import { factsOf, told } from './told.ts';

const names = namesOf(null);

function said(kind: string, content: Record<string, unknown>): string[] {
	const { what, on, who, why, outcome } = told({ kind, content }, names);
	return [what, on, who, why, outcome];
}

test('a tick says what it did, else what it heard', () => {
	expect(said('ticked', { started: ['robot.move'] })).toEqual(['Started', 'robot.move', '', '', '']);
	expect(said('ticked', { ended: ['a'], completed: ['b'], plan: { status: 'broken', reason: 'it was moved' } })).toEqual([
		'Ended, Completed, Plan broken',
		'Ended: a · Completed: b',
		'',
		'it was moved',
		''
	]);
	expect(said('ticked', { measured: { 'robot.pose': 'at_home', ready: null } })).toEqual([
		'Heard',
		'Robot.pose: at home, Ready: unknown',
		'',
		'',
		''
	]);
	expect(said('ticked', {})[0]).toBe('Tick');
});

test('each thing that a tick did is a fact of its own, and none is said twice', () => {
	const content = { started: ['a', 'b'], ended: ['place'], completed: ['place'], activated: ['tighten'] };
	expect(factsOf(told({ kind: 'ticked', content }, names))).toEqual(['Started: a', 'Started: b', 'Became active: tighten', 'Completed: place']);
	expect(factsOf(told({ kind: 'ticked', content: { ended: ['a'] } }, names))).toEqual(['Ended: a']);
	expect(factsOf(told({ kind: 'ticked', content: { started: ['1', '2', '3', '4', '5', '6'] } }, names)).at(-1)).toBe('Started: and 2 more');
});

test('what a person did says who and why', () => {
	expect(said('mode-changed', { what: { mode: 'hold', by: 'Eva' } })).toEqual(['Mode changed', 'Hold', 'Eva', '', '']);
	expect(said('corrected', { what: { values: { bolts: 'empty' }, by: 'Eva', why: 'seen' } })).toEqual([
		'Corrected',
		'Bolts: empty',
		'Eva',
		'seen',
		''
	]);
	expect(said('service-changed', { what: { of: 'resource', name: 'robot', in_service: false, by: 'Eva', why: '' } })[4]).toBe(
		'out of service'
	);
});

test('a job says what became of it', () => {
	expect(said('job-taken', { what: { job: '4711', title: 'Engine', work_master: 'engine', by: 'MES' } })).toEqual([
		'Job taken',
		'Engine',
		'MES',
		'',
		''
	]);
	expect(said('job-commanded', { what: { job: '4711', act: 'stop', by: 'Eva', why: 'late' } })).toEqual([
		'Job to be stopped',
		'4711',
		'Eva',
		'late',
		''
	]);
	expect(said('by-order-changed', { what: { on: true, by: 'Eva', why: '' } })).toEqual(['Work by order', 'on', 'Eva', '', '']);
});

test('an answer of the planner says what came of it', () => {
	const answer = { verdict: 'found', plan: { ticks: [{ starts: ['a', 'b'] }, { starts: [] }] } };
	expect(said('answered', { what: { answer } })).toEqual(['Planner answered', '', '', '', '2 starts']);
	expect(said('answered', { what: { answer }, plan: { status: 'followed', reason: 'planned for a', replaced: true } })).toEqual([
		'Plan replaced',
		'',
		'',
		'planned for a',
		'2 starts'
	]);
	expect(said('answered', { what: { answer: { verdict: 'none' } }, plan: { status: 'none', reason: '' } })).toEqual(['No plan', '', '', '', '']);
});

test('what became of an alarm is said in words, and how urgent it was', () => {
	const alarm = { event: 'returned', priority: 'medium', text: 'Nothing heard', resources: [] };
	expect(said('alarm', { what: alarm })).toEqual(expect.arrayContaining(['Alarm over, not acknowledged', 'Medium priority']));
	expect(said('alarm', { what: { ...alarm, event: 'melted' } })[0]).toBe('melted');
});

test('a kind that is not known keeps its own name', () => {
	expect(said('weather-changed', {})[0]).toBe('weather changed');
});
