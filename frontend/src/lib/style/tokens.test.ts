import { readdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { expect, test } from 'vitest';

const SOURCE = resolve(import.meta.dirname, '../..');

test('every property that a style reads is set somewhere: one that is not says nothing, and nobody would be told', () => {
	const files = readdirSync(SOURCE, { recursive: true, encoding: 'utf8' }).filter((path) => /\.(svelte|css|ts)$/.test(path) && !path.endsWith('.test.ts'));
	const texts = files.map((path) => ({ path, text: readFileSync(join(SOURCE, path), 'utf8') }));
	const set = new Set(texts.flatMap(({ text }) => [...text.matchAll(/(?<!var\()(--[\w-]+)(?=['"]?\s*[:=,)\]])/g)].map((found) => found[1])));
	const read = texts.flatMap(({ path, text }) => [...text.matchAll(/var\((--[\w-]+)\)/g)].map((found) => ({ path, name: found[1] })));
	expect(read.length).toBeGreaterThan(1000);
	expect(read.filter(({ name }) => !set.has(name))).toEqual([]);
});
