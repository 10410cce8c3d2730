/**
 * Who speaks to whom, as three columns: the nodes that publish, the topics, the nodes that subscribe. Each column is cut
 * into equal rows, so that lines between the middles of two rows meet what they join whatever the height is.
 */
import type { TopicRow } from './rows.ts';

export interface Line {
	/** Heights of both ends, as shares of the whole. */
	readonly from: number;
	readonly to: number;
	/** The two do not understand one another. */
	readonly broken: boolean;
}

export interface Picture {
	/** Names; null stands for all nodes that do not tell theirs. */
	readonly publishers: readonly (string | null)[];
	readonly topics: readonly TopicRow[];
	readonly subscribers: readonly (string | null)[];
	readonly left: readonly Line[];
	readonly right: readonly Line[];
}

/** The middle of row `place` in a column of `count`, as a share of its height. */
export function middle(place: number, count: number): number {
	return (place + 0.5) / count;
}

/** The picture of some topics. Nodes stand in the order of the topics that they are joined to, so that few lines cross. */
export function pictureOf(topics: readonly TopicRow[]): Picture {
	const publishers = column(topics, (row) => row.publishers);
	const subscribers = column(topics, (row) => row.subscribers);
	const lines = (names: readonly (string | null)[], ends: 'publishers' | 'subscribers'): Line[] =>
		topics.flatMap((row, place) =>
			[...new Set(row[ends].map((end) => end.node))].map((node) => {
				const [at, topic] = [middle(names.indexOf(node), names.length), middle(place, topics.length)];
				const broken = row.mismatches.some((mismatch) => mismatch.node === node);
				return ends === 'publishers' ? { from: at, to: topic, broken } : { from: topic, to: at, broken };
			})
		);
	return { publishers, topics, subscribers, left: lines(publishers, 'publishers'), right: lines(subscribers, 'subscribers') };
}

function column(topics: readonly TopicRow[], ends: (row: TopicRow) => TopicRow['publishers']): (string | null)[] {
	const places = new Map<string | null, number[]>();
	topics.forEach((row, place) => {
		for (const { node } of ends(row)) places.set(node, [...(places.get(node) ?? []), place]);
	});
	const mean = (all: readonly number[]): number => all.reduce((sum, n) => sum + n, 0) / all.length;
	return [...places].sort(([, a], [, b]) => mean(a) - mean(b)).map(([name]) => name);
}
