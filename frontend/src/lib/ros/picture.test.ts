import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Endpoint } from '#lib/contract.ts';
import { middle, pictureOf } from './picture.ts';
import type { TopicRow } from './rows.ts';

const end = (node: string | null): Endpoint => ({
	node,
	own: false,
	type: '',
	type_hash: null,
	quality: { reliability: 'reliable', durability: 'volatile', deadline: null, liveliness: null },
	vendor: null
});
const row = (name: string, publishers: (string | null)[], subscribers: (string | null)[]): TopicRow => ({
	name,
	types: [],
	resource: null,
	direction: null,
	standing: 'foreign',
	topic: null,
	quality: null,
	typeHash: null,
	mismatches: [],
	publishers: publishers.map(end),
	subscribers: subscribers.map(end)
});

test('every node stands once in its column, and every line joins the middles of two rows', () => {
	const nodes = fc.array(fc.constantFrom('/a', '/b', '/c', null), { maxLength: 4 });
	fc.assert(
		fc.property(fc.array(fc.tuple(nodes, nodes), { minLength: 1, maxLength: 6 }), (topics) => {
			const rows = topics.map(([from, to], place) => row(`/${place}`, from, to));
			const picture = pictureOf(rows);
			expect(new Set(picture.publishers).size).toBe(picture.publishers.length);
			const joined = rows.flatMap(({ publishers }, place) =>
				[...new Set(publishers.map(({ node }) => node))].map((node) => [
					middle(picture.publishers.indexOf(node), picture.publishers.length),
					middle(place, rows.length)
				])
			);
			expect(picture.left.map(({ from, to }) => [from, to])).toEqual(joined);
			expect(picture.right.every(({ from, to }) => from > 0 && from < 1 && to > 0 && to < 1)).toBe(true);
		})
	);
});

test('nodes stand in the order of the topics that they are joined to', () => {
	const picture = pictureOf([row('/first', ['/z'], []), row('/second', ['/a'], [])]);
	expect(picture.publishers).toEqual(['/z', '/a']);
});

test('a line to a node that is not understood is broken', () => {
	const mismatch = { kind: 'type', policy: null, node: '/b', ours: '', theirs: '', text: '', text_message: { id: 'as-it-was', arguments: { text: '' } } } as const;
	const picture = pictureOf([{ ...row('/t', ['/a', '/b'], []), mismatches: [mismatch] }]);
	expect(picture.left.map((line) => line.broken)).toEqual([false, true]);
});
