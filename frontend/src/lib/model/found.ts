/** Which entries the findings of a check are about. */
import type { Finding } from '#lib/contract.ts';
import type { Path } from './content.ts';
import { pathAt, placesOf, type Placed } from './places.ts';
import { around, nodeAt, type Lookup, type Node } from './tree.ts';

/** A finding with the entry that it is about; null where that is none of the tree. */
export interface Found {
	readonly finding: Finding;
	readonly node: Node | null;
	/** The entry at whose place it is. */
	readonly path: Path;
}

export interface Count {
	readonly errors: number;
	readonly warnings: number;
}

/** The findings with their entries, in the order in which they came. */
export function foundIn(
	findings: readonly Finding[],
	lookup: Lookup,
	files: Readonly<Record<string, Text | undefined>>
): Found[] {
	return findings.map((finding) => {
		const { file, line } = finding;
		const path = pathAt(placesIn(files[file]), line);
		return { finding, node: nodeAt(lookup, file, path), path };
	});
}

interface Text {
	readonly text: string;
}

/** Where entries stand in each file that was looked into: it is another object once its text is another. */
const PLACES = new WeakMap<Text, readonly Placed[]>();

function placesIn(file: Text | undefined): readonly Placed[] {
	if (file === undefined) return [];
	const places = PLACES.get(file) ?? placesOf(file.text);
	PLACES.set(file, places);
	return places;
}

/** How many there are at each entry and in it, by its id. */
export function countsOf(found: readonly Found[], lookup: Lookup): Map<string, Count> {
	const counts = new Map<string, Count>();
	for (const { finding, node } of found) {
		if (node === null) continue;
		for (const { id } of [...around(lookup, node.id), node]) {
			const { errors, warnings } = counts.get(id) ?? { errors: 0, warnings: 0 };
			const isError = finding.severity === 'error';
			counts.set(id, { errors: errors + (isError ? 1 : 0), warnings: warnings + (isError ? 0 : 1) });
		}
	}
	return counts;
}
