/** Titles of operations as they fit into a small box: of several of one kind the words that tell them apart. */
import type { DraftOperation } from '#lib/contract.ts';

/**
 * What each is called briefly, by name: *Place the bolts of pair 1* beside *… of pair 2* is *Place pair 1*, its first word, the
 * last that they share, and what is its own. One of its kind keeps its title.
 */
export function briefly(
	operations: Readonly<Record<string, Pick<DraftOperation, 'entry'>>>,
	titleOf: (name: string) => string
): Map<string, string> {
	const kinds = Map.groupBy(Object.entries(operations), ([, { entry }]) => entry);
	return new Map(
		[...kinds.values()].flatMap((members) => {
			const titles = members.map(([name]) => titleOf(name).split(' '));
			const shared = titles.length < 2 ? 0 : Math.min(...titles.map((words) => sharedBy(words, titles)));
			return members.map(([name], index) => {
				const words = titles[index] ?? [];
				const brief = shared < 3 ? words : [words[0], words[shared - 1], ...words.slice(shared)];
				return [name, brief.join(' ')] as const;
			});
		})
	);
}

/** With how many words all begin alike. */
function sharedBy(words: readonly string[], all: readonly (readonly string[])[]): number {
	let same = 0;
	while (same < words.length - 1 && all.every((other) => other[same] === words[same])) same += 1;
	return same;
}
