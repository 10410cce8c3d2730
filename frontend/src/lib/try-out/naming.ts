/** The name by which a test stands in its file: its title in letters that a name may have, and none that is taken. */
export function nameFor(title: string, taken: readonly string[]): string {
	const plain = title.normalize('NFD').replaceAll(/\p{M}/gu, '').toLowerCase();
	const word = plain.replaceAll(/[^a-z0-9]+/g, '_').replaceAll(/^_+|_+$/g, '').slice(0, 80) || 'test';
	const name = /^\d/.test(word) ? `test_${word}` : word;
	for (let n = 1; ; n++) {
		const each = n === 1 ? name : `${name}_${n}`;
		if (!taken.includes(each)) return each;
	}
}
