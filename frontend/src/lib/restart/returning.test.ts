import { expect, test } from 'vitest';
import type { OutOfService, Topic } from '#lib/contract.ts';
import { view } from '#lib/testing/view.ts';
import { returning } from './returning.ts';

const OUT: OutOfService = { of: 'resource', name: 'robot', title: 'Robot', since: 990, by: 'Eva', why: 'it squeaks', why_message: null };

function topic(trouble: string | null): Topic {
	const seen = { last: 999, messages: 7, deadline: 1, fresh: true, peers: 1 };
	return { type: 'msgs/msg/State', direction: 'in', resource: 'robot', trouble, trouble_message: null, ...seen };
}

test('a resource that is to come back is put back, awaited, not understood, or back', () => {
	const resources = { robot: { title: 'Robot', online: true, awaited_topics: [] } };
	const silent = { robot: { title: 'Robot', online: false, awaited_topics: ['/state'] } };
	const topics = { '/state': topic('not a message'), '/scene': topic(null), '/go': { ...topic('a rival'), direction: 'out' } };
	expect(returning(view({ resources: silent, topics, out_of_service: [OUT] }), 'robot')).toEqual({ how: 'out', out: OUT });
	expect(returning(view({ resources: silent, topics }), 'robot')).toEqual({ how: 'awaited', topics: ['/state'] });
	expect(returning(view({ resources, topics }), 'robot')).toEqual({ how: 'senseless', topics: ['/state'] });
	const sense = { ...topics, '/state': topic(null) };
	expect(returning(view({ resources, topics: sense }), 'robot')).toEqual({ how: 'back' });
	expect(returning(view({ resources, topics: sense, out_of_service: [{ ...OUT, of: 'ability' }] }), 'robot')).toEqual({ how: 'back' });
});
