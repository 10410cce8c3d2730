/** Entries of a file as they are written there, with the comments in them. */
import type { Pair } from 'yaml';
import { same, type Json, type Path } from './content.ts';

export type Yaml = typeof import('yaml');

/** The entry at `path` of a mapping in a file; null where it is not written out there, or where something stands for something else. */
export function pairAt(yaml: Yaml, file: string, path: Path): Pair | null {
	const document = yaml.parseDocument(file);
	const parent = document.errors.length > 0 ? null : document.getIn(path.slice(0, -1), true);
	if (!yaml.isMap(parent)) return null;
	const pair = parent.items.find(({ key }) => yaml.isScalar(key) && key.value === path.at(-1));
	if (pair === undefined || !yaml.isNode(pair.value)) return null;
	let plain = true;
	yaml.visit(pair.value, { Alias: () => void (plain = false), Value: (_, node) => void (plain &&= node.anchor === undefined) });
	return plain ? pair : null;
}

/** What an entry says, as it is written; null where there is no comment in it, so that it can be written like what is around it. */
export function commentedAt(yaml: Yaml, file: string, path: Path, value: Json): string | null {
	const pair = pairAt(yaml, file, path);
	if (pair === null) return null;
	const document = new yaml.Document();
	document.contents = pair.value as typeof document.contents;
	const text = document.toString({ lineWidth: 0, flowCollectionPadding: false });
	return text.includes('#') && same(yaml.parse(text) as Json, value) ? text : null;
}
