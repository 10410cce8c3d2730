import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { expect, test } from 'vitest';
import { front } from './en-front.ts';

const SOURCE = join(import.meta.dirname, '../..');
const ENTRIES = ['routes/+layout.svelte', 'routes/+error.svelte', 'routes/operator', 'routes/sign-in', 'routes/setup'];

/** The files behind `entry`: itself, or all of a folder and of those in it. */
function filesOf(entry: string): string[] {
	const path = join(SOURCE, entry);
	if (/\.\w+$/.test(entry)) return [path];
	const files = readdirSync(path, { recursive: true, withFileTypes: true }).filter((each) => each.isFile());
	return files.map(({ parentPath, name }) => join(parentPath, name));
}

/** Everything that is read with `entries`, without what is imported for its types or only later. */
function readWith(entries: string[]): Map<string, string> {
	const found = new Map<string, string>();
	const waiting = entries.flatMap(filesOf);
	for (let path = waiting.pop(); path !== undefined; path = waiting.pop()) {
		if (found.has(path)) continue;
		const text = readFileSync(path, 'utf8');
		found.set(path, text);
		for (const [, address = ''] of text.matchAll(/^\s*import (?!type )(?:[^;]*? from )?'([^']+)';/gms)) {
			if (address.startsWith('#lib/')) waiting.push(join(SOURCE, 'lib', address.slice('#lib/'.length)));
			else if (address.startsWith('.')) waiting.push(join(dirname(path), address));
		}
	}
	return new Map([...found].filter(([path]) => /\.(svelte|ts)$/.test(path)));
}

test('what the watch and the pages before the sign-in say is in the catalogue that is read with them', () => {
	const read = readWith(ENTRIES);
	expect(read.size).toBeGreaterThan(20);
	expect([...read.keys()].map((path) => relative(SOURCE, path))).not.toContain('lib/text/en.ts');
	for (const [path, text] of read)
		for (const [, room] of text.matchAll(/\bsay\(\)\.(\w+)/g)) expect(Object.keys(front), relative(SOURCE, path)).toContain(room);
});
