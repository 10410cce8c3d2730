/** The topics of the network and of the station as one list, each with how it stands. */
import type { Endpoint, GraphTopic, Mismatch, Network, Quality, Topic } from '#lib/contract.ts';

/**
 * How a topic stands. What the station reads is `fresh`, or `stale` when it spoke too long ago while its publisher is
 * there; it is silent when its publisher is `gone`, has not been heard (`unheard`), or was never there (`absent`). What the
 * station writes is `met` or `unmet`. A `mismatch` or other `trouble` comes before all that; others are `foreign`.
 */
export type Standing =
	| 'mismatch'
	| 'trouble'
	| 'absent'
	| 'gone'
	| 'unheard'
	| 'stale'
	| 'unmet'
	| 'fresh'
	| 'met'
	| 'foreign';

/** Those with which something is wrong, the gravest first. */
export const WRONG = ['mismatch', 'trouble', 'absent', 'gone', 'unheard', 'stale', 'unmet'] as const;
export type Wrong = (typeof WRONG)[number];

export function isWrong(standing: Standing): standing is Wrong {
	return (WRONG as readonly Standing[]).includes(standing);
}

export interface TopicRow {
	readonly name: string;
	readonly types: readonly string[];
	/** Null where the station has no part in it; so are all below but the endpoints. */
	readonly resource: string | null;
	readonly direction: 'in' | 'out' | null;
	readonly standing: Standing;
	readonly topic: Topic | null;
	/** What the model says of it. */
	readonly quality: Quality | null;
	readonly typeHash: string | null;
	readonly mismatches: readonly Mismatch[];
	readonly publishers: readonly Endpoint[];
	readonly subscribers: readonly Endpoint[];
}

/** All topics by name: those that need a person first, then those of the station, then others. */
export function rowsOf(topics: Readonly<Record<string, Topic>>, network: Network | null): TopicRow[] {
	const graph = network?.topics ?? {};
	const names = new Set([...Object.keys(topics), ...Object.keys(graph)]);
	return [...names]
		.map((name) => rowOf(name, topics[name] ?? null, graph[name] ?? null))
		.sort((a, b) => rank(a) - rank(b) || (a.name < b.name ? -1 : 1));
}

function rank({ standing }: TopicRow): number {
	return isWrong(standing) ? WRONG.indexOf(standing) : standing === 'foreign' ? WRONG.length + 1 : WRONG.length;
}

function rowOf(name: string, topic: Topic | null, graph: GraphTopic | null): TopicRow {
	const use = graph?.station ?? null;
	const direction = use?.direction ?? (topic === null ? null : topic.direction === 'out' ? 'out' : 'in');
	return {
		name,
		types: graph?.types ?? (topic === null ? [] : [topic.type]),
		resource: use?.resource ?? topic?.resource ?? null,
		direction,
		standing: standingOf(topic, graph),
		topic,
		quality: use?.quality ?? null,
		typeHash: use?.type_hash ?? null,
		mismatches: use?.mismatches ?? [],
		publishers: graph?.publishers ?? [],
		subscribers: graph?.subscribers ?? []
	};
}

/** How a topic stands, by what the station says of it and by what is on the network. */
export function standingOf(topic: Topic | null, graph: GraphTopic | null): Standing {
	const use = graph?.station ?? null;
	if (use !== null && use.mismatches.length > 0) return 'mismatch';
	// The topics of actions are in no list of the station; what is wrong with them is a mismatch.
	if (topic === null) return use === null ? 'foreign' : 'met';
	if (topic.trouble !== null) return 'trouble';
	if (topic.direction === 'out') return topic.peers > 0 ? 'met' : 'unmet';
	if (topic.fresh) return 'fresh';
	const published = graph === null ? topic.peers > 0 : graph.publishers.length > 0;
	if (topic.last === null) return published ? 'unheard' : 'absent';
	return published ? 'stale' : 'gone';
}

/** What a person looks for among the topics. */
export interface Search {
	/** Words that are all in its name, a type, or the name of a node. */
	readonly text: string;
	readonly resource: string | null;
	readonly show: 'all' | 'station' | 'wrong';
}

/** The rows that are looked for. */
export function found(rows: readonly TopicRow[], { text, resource, show }: Search): TopicRow[] {
	const words = text.toLowerCase().split(/\s+/).filter(Boolean);
	return rows.filter((row) => {
		if (resource !== null && row.resource !== resource) return false;
		if (show === 'station' && row.standing === 'foreign') return false;
		if (show === 'wrong' && !isWrong(row.standing)) return false;
		if (words.length === 0) return true;
		const nodes = [...row.publishers, ...row.subscribers].map((end) => end.node ?? '');
		const said = [row.name, ...row.types, ...nodes].join(' ').toLowerCase();
		return words.every((word) => said.includes(word));
	});
}

/** What is wrong in one way with topics of some resources. */
export interface Group {
	readonly standing: Exclude<Wrong, 'mismatch'>;
	readonly resources: readonly string[];
	readonly rows: readonly TopicRow[];
}

/** All that is wrong but mismatches, which are told one by one: the gravest first. */
export function groupsOf(rows: readonly TopicRow[]): Group[] {
	return WRONG.filter((standing) => standing !== 'mismatch').flatMap((standing) => {
		const here = rows.filter((row) => row.standing === standing);
		const resources = [...new Set(here.map((row) => row.resource ?? ''))];
		return here.length === 0 ? [] : [{ standing, resources, rows: here }];
	});
}

/** The names of the nodes at some endpoints, each once; null for those that do not tell theirs. */
export function nodesOf(ends: readonly Endpoint[]): (string | null)[] {
	return [...new Set(ends.map((end) => end.node))].sort((a, b) => Number(a === null) - Number(b === null) || (a! < b! ? -1 : 1));
}
