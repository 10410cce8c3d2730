import { describe, expect, test } from 'vitest';
import type { AbilityDefinition, Predicate, Reaction, Trial } from '#lib/contract.ts';
import { addressOf } from './address.ts';
import { belongs, cameOf, isNew, stepsOf } from './course.ts';
import { isOf, reactionName, wholeName } from './names.ts';
import { phaseOf } from './phase.ts';
import { rowsOf } from './rows.ts';

const flags = { enabled: false, executing: false, finished: false, running_since: null };

const trial = (rest: Partial<Trial> = {}): Trial => ({
	by: 'Eva',
	reason: '',
	accepted: 100,
	started: null,
	executing: null,
	ended: null,
	done: false,
	why: '',
	reactions: [],
	...rest
});

const place = { file: 'resources/robot.yaml', line: 3 };

const predicate = (...parts: [text: string, holds: boolean | null][]): Predicate => ({
	text: parts.map(([text]) => text).join(' and ') || 'true',
	holds: parts.every(([, holds]) => holds),
	parts: parts.map(([text, holds]) => ({ text, sentence: { id: 'sentence.so' }, holds, reads: [{ name: 'robot.pose', kind: 'measured', value: 'home' }] })),
	place
});

const reaction: Reaction = {
	name: 'robot.move(home).robot_arrives',
	kind: 'executing',
	guard: predicate(['pose == unknown', false]),
	actions: [{ text: 'robot.pose := home', variable: 'robot.pose', done: true }],
	shortest: 1,
	longest: 2,
	fault: false
};

describe('where an ability is', () => {
	test.each([
		[{}, 'idle'],
		[{ enabled: true }, 'enabled'],
		[{ enabled: null }, 'unknown'],
		[{ enabled: true, finished: true }, 'finished'],
		[{ finished: true, running_since: 3 }, 'started'],
		[{ enabled: true, executing: true, running_since: 3 }, 'executing']
	] as const)('%j is %s', (some, phase) => expect(phaseOf({ ...flags, ...some })).toBe(phase));
});

describe('the course of a trial', () => {
	const names = (sent: number | null, of: Trial | null): string[] => stepsOf(sent, of).map(({ name, mark }) => `${name} ${mark}`);

	test('what was sent is not accepted yet', () => {
		expect(names(99, null)).toEqual(['sent done', 'accepted now', 'started ahead', 'executing ahead', 'finished ahead']);
	});
	test('one step is under way at a time', () => {
		expect(names(null, trial({ started: 100.1 }))).toEqual(['accepted done', 'started done', 'executing now', 'finished ahead']);
	});
	test('one that was never seen executing has finished all the same', () => {
		const done = trial({ started: 100.1, ended: 101, done: true });
		expect(names(99, done)).toEqual(['sent done', 'accepted done', 'started done', 'executing never', 'finished done']);
	});
	test('one that ended before its end says so', () => {
		const over = trial({ started: 100.1, executing: 100.2, ended: 105, why: 'Eva stopped it' });
		expect(names(null, over)).toEqual(['accepted done', 'started done', 'executing done', 'ended done']);
		expect(names(null, trial({ ended: 100.1 })).slice(1)).toEqual(['started never', 'executing never', 'ended done']);
	});
	test('a trial is known by when it was accepted', () => {
		const sent = { at: 99.9, before: 50 };
		expect(isNew(sent, null)).toBe(false);
		expect(isNew(sent, trial({ accepted: 50 }))).toBe(false);
		expect(isNew(sent, trial())).toBe(true);
		expect(belongs(sent, trial())).toBe(true);
		expect(belongs(sent, trial({ accepted: 400 }))).toBe(false);
	});
	test.each([
		[{ due: 100, came: 101 }, false, 200, 'came'],
		[{ due: 100, came: null }, false, 105, 'due'],
		[{ due: 100, came: null }, false, 105.1, 'missing'],
		[{ due: null, came: null }, false, 200, 'untouched'],
		[{ due: 100, came: null }, true, 200, 'faultless'],
		[{ due: 100, came: 101 }, true, 200, 'came']
	] as const)('a reaction of 2 s at most that was %j, fault %s, at %s: %s', (tried, fault, now, came) => {
		expect(cameOf({ ...reaction, fault }, { name: reaction.name, ...tried }, now)).toBe(came);
	});
	test('of a reaction that nobody heard of nothing is said', () => {
		expect(cameOf(reaction, undefined, 200)).toBe('untouched');
	});
});

test('the table has all parts in the order of a run', () => {
	const definition: AbilityDefinition = {
		name: 'robot.move(home)',
		title: 'Move',
		resource: 'robot',
		arguments: ['home'],
		place,
		restart: false,
		task: null,
		acknowledgement: null,
		duration: null,
		revision: 1,
		enabled: predicate(['a', true], ['b', null]),
		start: predicate(),
		start_actions: [{ text: 't := home', variable: 't', done: false }],
		supervised: { guard: predicate(['s', false]), specifications: [], rest: false, blocked: [] },
		allowed: false,
		executing: predicate(['e', false]),
		finished: predicate(),
		finish: null,
		finish_actions: [],
		cancel_actions: [],
		timeouts: { react: null, finish: null, retries: 0, replan: false },
		reactions: [reaction],
		obstacle: null,
		obstacle_message: null,
		real_devices: [],
		trial: null
	};
	expect(rowsOf(definition).map(({ part, text, now }) => [part, text, now])).toEqual([
		['enabled', 'a', true],
		['enabled', 'b', null],
		['start', 'true', true],
		['supervised', 's', false],
		['startActions', 't := home', false],
		['executing', 'e', false],
		['reaction', 'pose == unknown', false],
		['reaction', 'robot.pose := home', true],
		['finished', 'true', true]
	]);
});

test('names and addresses', () => {
	expect(reactionName('robot.move_to_position(above_engine).robot_arrives')).toBe('robot arrives');
	expect(addressOf('robot.move(above engine)')).toBe('/model?ability=robot.move%28above+engine%29');
	expect(wholeName('robot.move(above engine)')).toBe('robot.move');
	expect(wholeName('robot.stop')).toBe('robot.stop');
	expect(isOf('robot.move(home)', 'robot.move')).toBe(true);
	expect(isOf('robot.move_on', 'robot.move')).toBe(false);
});
