import { expect, test } from 'vitest';
import type { Condition, Involved } from '#lib/contract.ts';
import { operate } from '#lib/text/en/operate.ts';
import { sentenceOf, waitText } from './condition.ts';

const ABILITIES = { 'nutrunner.run_nut': { title: 'Run the nutrunner' } };

test.each([
	['nutrunner.run_nut.executing', 'waits until Run the nutrunner is executing'],
	['not nutrunner.run_nut.executing', 'waits until Run the nutrunner is not executing'],
	['nutrunner.run_nut.finished', 'waits until Run the nutrunner has finished'],
	['robot.unknown.executing', 'waits for robot.unknown.executing'],
	['a message on /ur10/state', 'waits for a message on /ur10/state'],
	['constructor.executing', 'waits for constructor.executing']
])('%s is said as: %s', (condition, said) => {
	expect(waitText(condition, ABILITIES, operate.why)).toBe(said);
});

const involved = (name: string, wanted: Involved['wanted']): Involved => ({
	name,
	kind: 'measured',
	resource: 'robot',
	value: 'home',
	wanted,
	since: 1,
	topic: null,
	unconfirmed_since: null,
	changers: []
});
const condition = (text: string, ...all: Involved[]): Condition => ({ kind: 'written', text, text_message: { id: 'as-it-was', arguments: { text } }, expanded: null, involved: all });

test('where one variable decides, its values are said; where several do, the condition as it is written', () => {
	const say = (each: Condition): string => sentenceOf(each, ABILITIES, operate.why);
	expect(say(condition('robot.pose in {home, out}', involved('robot.pose', ['home', 'far_out'])))).toBe(
		'waits until robot.pose is home or far out'
	);
	expect(say(condition('a or b', involved('a', [true]), involved('b', [true])))).toBe('waits for a or b');
	expect(say(condition('a == b', involved('a', [])))).toBe('waits for a == b');
	expect(say(condition('nutrunner.run_nut.executing', involved('nutrunner.tool_is_idle', [false])))).toBe(
		'waits until Run the nutrunner is executing'
	);
});
