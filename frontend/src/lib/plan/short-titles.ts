/** So many words each keeps, so that what is left is still said of something. */
const KEPT = 2;

/**
 * The titles without the words with which others begin too, so that a short bar says what is its own: “Move to bolt pair 1”
 * beside “Move to above engine” and “Attach the tool” is “pair 1”. Where two would be told alike, both stay as they are.
 */
export function shortTitles(titles: readonly string[]): string[] {
	const all = [...new Set(titles)].map((title) => title.split(' '));
	const short = new Map(all.map((words) => [words.join(' '), words.slice(sharedBy(words, all)).join(' ')]));
	const times = new Map<string, number>();
	for (const each of short.values()) times.set(each, (times.get(each) ?? 0) + 1);
	return titles.map((title) => {
		const brief = short.get(title) ?? title;
		return times.get(brief) === 1 ? brief : title;
	});
}

/** With how many of its first words another begins as well, without those that it keeps. */
function sharedBy(words: readonly string[], all: readonly (readonly string[])[]): number {
	let most = 0;
	for (const other of all) {
		if (other === words) continue;
		let same = 0;
		while (same < Math.min(words.length, other.length) - KEPT && words[same] === other[same]) same += 1;
		most = Math.max(most, same);
	}
	return most;
}
