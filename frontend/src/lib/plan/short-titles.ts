/** The titles without the words with which all of them begin, so that a short bar says what is its own; each keeps two. */
export function shortTitles(titles: readonly string[]): string[] {
	const words = titles.map((title) => title.split(' '));
	const differ = new Set(titles).size > 1;
	let same = 0;
	while (differ && words.every((each) => each.length > same + 2 && each[same] === words[0]?.[same])) same += 1;
	return words.map((each) => each.slice(same).join(' '));
}
