import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { expect, test } from 'vitest';
import { front } from './en-front.ts';
import { station } from './en-station.ts';

const SOURCE = join(import.meta.dirname, '../..');
const FRONT = ['routes/+layout.svelte', 'routes/+error.svelte', 'routes/operator', 'routes/sign-in', 'routes/setup'];
/** Where the pages lie that bring all rooms. */
const WORKSHOP = 'routes/(station)/(workshop)';

/** The files behind `entry`: itself, or all of a folder and of those in it. */
function filesOf(entry: string): string[] {
	const path = join(SOURCE, entry);
	if (/\.\w+$/.test(entry)) return [path];
	const files = readdirSync(path, { recursive: true, withFileTypes: true }).filter((each) => each.isFile());
	return files.map(({ parentPath, name }) => join(parentPath, name));
}

/** Everything that is read with `entries`, without what is imported for its types; with `later`, what is read only when asked for too. */
function readWith(entries: string[], later = false): Map<string, string> {
	const imported = later ? /(?:^\s*import (?!type )(?:[^;]*? from )?|\bimport\()'([^']+)'/gms : /^\s*import (?!type )(?:[^;]*? from )?'([^']+)'/gms;
	const found = new Map<string, string>();
	const waiting = entries;
	for (let path = waiting.pop(); path !== undefined; path = waiting.pop()) {
		if (found.has(path)) continue;
		const text = readFileSync(path, 'utf8');
		found.set(path, text);
		for (const [, address = ''] of text.matchAll(imported)) {
			if (address.startsWith('#lib/')) waiting.push(join(SOURCE, 'lib', address.slice('#lib/'.length)));
			else if (address.startsWith('.')) waiting.push(join(dirname(path), address));
		}
	}
	return new Map([...found].filter(([path]) => /\.(svelte|ts)$/.test(path)));
}

/** Every file of `read` that says something, with the rooms it says it from. */
function roomsOf(read: Map<string, string>): [path: string, room: string | undefined][] {
	return [...read].flatMap(([path, text]) =>
		[...text.matchAll(/\bsay\(\)\.(\w+)/g)].map(([, room]): [string, string | undefined] => [relative(SOURCE, path), room])
	);
}

const named = (read: Map<string, string>): string[] => [...read.keys()].map((path) => relative(SOURCE, path));

test('what the watch and the pages before the sign-in say is in the catalogue that is read with them', () => {
	const read = readWith(FRONT.flatMap(filesOf));
	expect(read.size).toBeGreaterThan(20);
	expect(named(read)).not.toContain('lib/text/en-station.ts');
	for (const [path, room] of roomsOf(read)) expect(Object.keys(front), path).toContain(room);
});

test('what the pages of operators and the frame say is in the catalogue that is read with them', () => {
	const pages = filesOf('routes/(station)').filter((path) => !path.startsWith(join(SOURCE, WORKSHOP)));
	const read = readWith(pages, true);
	expect(read.size).toBeGreaterThan(100);
	expect(named(read)).toEqual(expect.arrayContaining(['lib/text/en-station.ts', 'lib/text/sv-station.ts']));
	expect(named(read)).not.toContain('lib/text/en.ts');
	expect(named(read)).not.toContain('lib/text/sv.ts');
	for (const [path, room] of roomsOf(read)) expect(Object.keys(station), path).toContain(room);
});
