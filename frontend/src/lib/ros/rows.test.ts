import { describe, expect, test } from 'vitest';
import type { Endpoint, GraphTopic, Mismatch, Network, Topic } from '#lib/contract.ts';
import { found, groupsOf, rowsOf, standingOf } from './rows.ts';

const QUALITY = { reliability: 'reliable', durability: 'volatile', deadline: null, liveliness: null } as const;
const end = (node: string | null, own = false): Endpoint => ({
	node,
	own,
	type: 'p/msg/T',
	type_hash: null,
	quality: QUALITY,
	vendor: null
});
const topic = (rest: Partial<Topic> = {}): Topic => ({
	type: 'p/msg/T',
	direction: 'in',
	resource: 'robot',
	last: 5,
	messages: 1,
	deadline: 1,
	fresh: true,
	peers: 1,
	trouble: null,
	trouble_message: null,
	...rest
});
const MISMATCH: Mismatch = { kind: 'rival', policy: null, node: '/x', ours: '', theirs: '', text: '', text_message: { id: 'as-it-was', arguments: { text: '' } } };

function graph(publishers: Endpoint[] = [], mismatches: Mismatch[] | null = [], resource = 'robot'): GraphTopic {
	const use = { resource, direction: 'in', type: 'p/msg/T', type_hash: '', quality: QUALITY, peers: 0 } as const;
	return { types: ['p/msg/T'], publishers, subscribers: [], station: mismatches && { ...use, mismatches } };
}

describe('a topic', () => {
	test.each([
		['fresh', topic(), graph([end('/robot')])],
		['stale', topic({ fresh: false }), graph([end('/robot')])],
		['gone', topic({ fresh: false }), graph()],
		['unheard', topic({ fresh: false, last: null }), graph([end('/robot')])],
		['absent', topic({ fresh: false, last: null }), graph()],
		['absent', topic({ fresh: false, last: null, peers: 0 }), null],
		['trouble', topic({ trouble: 'no sense' }), graph([end('/robot')])],
		['mismatch', topic({ trouble: 'another type' }), graph([end('/robot')], [MISMATCH])],
		['met', topic({ direction: 'out' }), graph()],
		['unmet', topic({ direction: 'out', peers: 0 }), graph()],
		['foreign', null, graph([end('/robot')], null)]
	] as const)('is %s', (standing, told, seen) => {
		expect(standingOf(told, seen)).toBe(standing);
	});
});

const NETWORK: Network = {
	nodes: {},
	topics: { '/robot/state': graph(), '/chatter': graph([end('/talker')], null), '/tool/state': graph([end('/tool')], [], 'tool') },
	services: {},
	actions: {},
	services_known: true
};
const ROWS = rowsOf({ '/robot/state': topic({ fresh: false }), '/tool/state': topic({ resource: 'tool' }) }, NETWORK);
const names = (rows: readonly { name: string }[]): string[] => rows.map((row) => row.name);

test('what is wrong comes first, then what is of the station, then others', () => {
	expect(names(ROWS)).toEqual(['/robot/state', '/tool/state', '/chatter']);
});

test('topics are found by their names, types and nodes, by resource, and by what is wrong', () => {
	const search = (rest: object) => names(found(ROWS, { text: '', resource: null, show: 'all', ...rest }));
	expect(search({ text: 'STATE tool' })).toEqual(['/tool/state']);
	expect(search({ text: 'talk' })).toEqual(['/chatter']);
	expect(search({ resource: 'tool' })).toEqual(['/tool/state']);
	expect(search({ show: 'station' })).toEqual(['/robot/state', '/tool/state']);
	expect(search({ show: 'wrong' })).toEqual(['/robot/state']);
});

test('what is wrong in the same way is told together', () => {
	const silent = { '/a': topic({ fresh: false }), '/b': topic({ fresh: false, resource: 'tool' }), '/c': topic() };
	const groups = groupsOf(rowsOf(silent, { ...NETWORK, topics: { '/a': graph(), '/b': graph([], [], 'tool') } }));
	expect(groups.map(({ standing, resources, rows }) => [standing, resources, names(rows)])).toEqual([
		['gone', ['robot', 'tool'], ['/a', '/b']]
	]);
});
