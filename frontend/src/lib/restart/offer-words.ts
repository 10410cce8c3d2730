/** How an offer is said in short. */
import type { WayOffer } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';

type Ways = Text['restart']['ways'];

/** What it asks for; a kind that this page does not know keeps its own word. */
export function kindWord({ kinds }: Pick<Ways, 'kinds'>, kind: string): string {
	return Object.entries(kinds).find(([name]) => name === kind)?.[1] ?? kind;
}

/** What it takes: nothing is said of what it does not. */
export function effortWords(texts: Ways, effort: WayOffer['effort']): string[] {
	const said: [number, string][] = [
		[effort.physical, texts.acts(effort.physical)],
		[effort.returns, texts.returns(effort.returns)],
		[effort.corrections, texts.changes(effort.corrections)],
		[effort.starts, texts.starts(effort.starts)],
		[Math.ceil(effort.seconds), texts.seconds(Math.ceil(effort.seconds))]
	];
	return said.flatMap(([n, words]) => (n > 0 ? [words] : []));
}
