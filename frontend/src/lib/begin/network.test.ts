import { expect, test } from 'vitest';
import type { Network } from '#lib/contract.ts';
import { nodesOn, nodeTitle } from './network.ts';

const end = (node: string | null, own = false) => ({ node, own }) as Network['topics'][string]['publishers'][number];
const topic = (publishers: string[], subscribers: string[] = [], more: object = {}) =>
	({ types: ['a/msg/B'], station: null, publishers: publishers.map((each) => end(each)), subscribers: subscribers.map((each) => end(each)), ...more }) as Network['topics'][string];

test('topics are of the node that publishes them, or else hears them; those of the station and of ROS are left out', () => {
	const topics: Network['topics'] = {
		'/ur/state': topic(['/ur'], ['/logger']),
		'/ur/command': topic([], ['/ur']),
		'/a': topic(['/camera']),
		'/rosout': topic(['/ur']),
		'/sequence_planner/emulator/faults': topic([], ['/emulated_devices']),
		'/ours': topic([], [], { publishers: [end('/station', true)] }),
		'/nameless': topic([], [], { publishers: [end(null)] })
	};
	const found = nodesOn({ topics } as Network);
	expect(found.map(({ name, topics: all }) => [name, all.map((each) => each.name)])).toEqual([
		['/camera', ['/a']],
		['/ur', ['/ur/command', '/ur/state']],
		[null, ['/nameless']]
	]);
});

test('nothing is there where nothing was read', () => {
	expect(nodesOn(null)).toEqual([]);
});

test.each([
	['/cell/ur_driver', 'Ur driver'],
	['/lamp', 'Lamp'],
	['/', '']
])('the node %s is called %j', (node, title) => {
	expect(nodeTitle(node)).toBe(title);
});
