import { describe, expect, test } from 'vitest';
import type { Topic } from '#lib/contract.ts';
import { estimate, view } from '#lib/testing/view.ts';
import { aboutOf } from './about.ts';

const topic = (resource: string, rest: Partial<Topic> = {}): Topic => ({
	type: 'p/msg/T',
	direction: 'in',
	resource,
	last: null,
	messages: 0,
	deadline: 1,
	fresh: false,
	peers: 0,
	trouble: null,
	...rest
});
const resource = (title: string) => ({ title, online: true, awaited_topics: [] });

const STATION = view({
	resources: { robot: resource('Robot'), tool: resource('Tool') },
	variables: { 'robot.speed': estimate({ resource: 'robot' }) },
	topics: {
		'/robot/state': topic('robot'),
		'/robot/joints': topic('robot', { fresh: true }),
		'/robot/command': topic('robot', { direction: 'out', trouble: 'not sent' }),
		'/tool/state': topic('tool', { fresh: true, trouble: 'no sense' })
	}
});

describe('an alarm is about', () => {
	test.each([
		['silent:robot', ['robot'], ['/robot/state']],
		['network:tool', ['tool'], ['/tool/state']],
		['given-up:tool', ['tool'], []],
		['forced:robot.speed', ['robot'], []],
		['message:/tool/state:a: b', ['tool'], ['/tool/state']],
		['many-silent', ['robot'], ['/robot/state']],
		['rival', ['robot'], ['/robot/command']],
		['silent:somebody else', [], []],
		['unjournalled', [], []]
	])('%s', (key, resources, topics) => {
		expect(aboutOf(key, STATION)).toEqual({ resources, topics, restart: false });
	});
});

test('a plan that is missing is a matter of Restart', () => {
	expect(aboutOf('no-plan', STATION).restart).toBe(true);
});
