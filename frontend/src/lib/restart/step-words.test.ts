import { expect, test } from 'vitest';
import { alarm, view } from '#lib/testing/view.ts';
import { en } from '#lib/text/en.ts';
import { sv } from '#lib/text/sv.ts';
import { sayActs } from './act-words.ts';
import { haltedAlarms } from './shown.ts';
import { doneSteps, stepWords } from './step-words.ts';

test('all that a button does is said on it, as one sentence', () => {
	expect(sayActs(['control', 'enter'], null, en)).toBe('Take control and enter restart mode');
	expect(sayActs(['control', 'leave', 'go'], null, en)).toBe('Take control, leave restart mode and continue');
	expect(sayActs(['control'], 'Wait for the robot', en)).toBe('Take control and wait for the robot');
	expect(sayActs([], 'Wait for the robot', en)).toBe('Wait for the robot');
	expect(sayActs(['control', 'start'], null, sv)).toBe('Ta kontrollen och starta produktionen');
});

test('steps before the next one are done, but for a state that is still asked about', () => {
	const late = { alarms: { late: alarm() } };
	expect(doneSteps(view(late), 'understand')).toEqual({ understand: false, state: false, ways: false, on: false });
	expect(doneSteps(view(late), 'ways')).toEqual({ understand: true, state: true, ways: false, on: false });
	expect(doneSteps(view({ ...late, unconfirmed: true }), 'ways').state).toBe(false);
	expect(doneSteps(view({ mode: 'restart' }), 'on')).toEqual({ understand: true, state: true, ways: true, on: false });
});

test('of a device that is not heard nobody says that it stands still', () => {
	const seen = (silent: string[]): string => stepWords({ view: view({ silent }), next: 'enter', step: 'state', advice: null, now: 0 }).understand;
	expect(seen([])).toContain('All devices stand still.');
	expect(seen(['Robot UR10'])).toContain('Nobody knows whether Robot UR10 moves.');
	expect(seen(['Robot UR10'])).not.toContain('stand still');
});

test('what was moved by hand is named where it happened, and the state is not taken for true while it is told', () => {
	const moved = alarm({ kind: 'by-hand', priority: 'low', text: 'The tool dock has changed without a command. The tool is away.', messages: undefined });
	const held = view({ mode: 'hold', alarms: { 'by-hand:dock': moved } });
	const said = stepWords({ view: held, next: 'continue', step: 'on', advice: null, now: 0 });
	expect(said.understand).toContain('The tool dock has changed without a command.');
	expect(said.understand).toContain('All devices stand still.');
	expect(said.state).toBe('Look whether what the station believes is still true. The tool dock has changed without a command.');
	expect(doneSteps(held, 'on')).toEqual({ understand: true, state: false, ways: true, on: false });
	const looked = view({ mode: 'hold', alarms: { 'by-hand:dock': { ...moved, by: 'Eva' } } });
	expect(doneSteps(looked, 'on').state).toBe(true);
	expect(stepWords({ view: looked, next: 'continue', step: 'on', advice: null, now: 0 }).understand).toContain('The tool dock has changed');
	const over = view({ mode: 'hold', alarms: { 'by-hand:dock': { ...moved, ended: 990 } } });
	expect(doneSteps(over, 'on').state).toBe(true);
});

test('what a Hold has called off is to be seen to before the station goes on', () => {
	const stands = { resource: 'nutrunner', title: 'Run', human: false, restart: false, moves: true, enabled: true, executing: false, finished: false, running_since: null };
	const late = alarm({ kind: 'overdue', subject: 'run', priority: 'medium', action: 'Look at its display. Then switch it on.', messages: undefined });
	const held = view({ mode: 'hold', alarms: { 'overdue:run': late }, abilities: { run: stands } });
	expect(haltedAlarms(held)).toHaveLength(1);
	expect(doneSteps(held, 'on').ways).toBe(false);
	expect(stepWords({ view: held, next: 'continue', step: 'on', advice: null, now: 0 }).ways).toBe('Before you go on: Look at its display.');
	expect(doneSteps({ ...held, alarms: { 'overdue:run': { ...late, state: 'acknowledged', by: 'Eva' } } }, 'on').ways).toBe(true);
	expect(haltedAlarms({ ...held, mode: 'automatic' })).toEqual([]);
});
