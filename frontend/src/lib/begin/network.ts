/** What is on the network, as devices that a station could have: nodes with their topics. */
import type { Network } from '#lib/contract.ts';

export interface FoundNode {
	/** As it is called on the network; null for those that tell no name. */
	readonly name: string | null;
	/** Its topics in their order, each with its types. */
	readonly topics: readonly { readonly name: string; readonly types: readonly string[] }[];
}

/** Those that nodes have for ROS itself, and by which emulated devices are told what happens to them. */
const ASIDE = /^\/(?:rosout|parameter_events|clock|sequence_planner\/.*)$/;

/** The nodes that are not the station itself, each topic with who publishes it, or else with who hears it. */
export function nodesOn(network: Network | null): FoundNode[] {
	const nodes = new Map<string | null, { name: string; types: readonly string[] }[]>();
	for (const [name, { types, publishers, subscribers, station }] of Object.entries(network?.topics ?? {})) {
		if (ASIDE.test(name) || station !== null) continue;
		const end = [...publishers, ...subscribers].find(({ own }) => !own);
		if (end === undefined) continue;
		const there = nodes.get(end.node);
		if (there) there.push({ name, types });
		else nodes.set(end.node, [{ name, types }]);
	}
	const named = [...nodes].map(([name, topics]): FoundNode => ({ name, topics: topics.toSorted(byName) }));
	return named.toSorted((a, b) => (a.name === null ? 1 : b.name === null ? -1 : a.name < b.name ? -1 : 1));
}

const byName = (a: { readonly name: string }, b: { readonly name: string }): number => (a.name < b.name ? -1 : 1);

/** What a node is called for people: `/cell/ur_driver` is `Ur driver`. */
export function nodeTitle(node: string): string {
	const words = (node.split('/').findLast((part) => part !== '') ?? '').replaceAll(/[_\s]+/g, ' ').trim();
	return words.charAt(0).toUpperCase() + words.slice(1);
}
