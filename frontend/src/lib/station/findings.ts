/** Which things the findings of the check are about: those in whose lines they are. */
import type { Finding } from '#lib/contract.ts';
import { isPiece, type Whole } from './graph.ts';

/** The findings at each piece, or each resource. */
export function findingsAt(whole: Whole, findings: readonly Finding[]): Map<number, Finding[]> {
	const places = new Map<string, { line: number; index: number }[]>();
	for (const thing of whole.things) {
		const isPlace = isPiece(thing) || thing.kind === 'resource';
		if (!isPlace || thing.standing !== 'declared' || thing.file === null) continue;
		const there = places.get(thing.file) ?? [];
		places.set(thing.file, there);
		there.push({ line: thing.line, index: thing.index });
	}
	for (const each of places.values()) each.sort((one, other) => one.line - other.line);
	const found = new Map<number, Finding[]>();
	for (const finding of findings) {
		const at = places.get(finding.file)?.findLast(({ line }) => line <= finding.line);
		if (at) found.set(at.index, [...(found.get(at.index) ?? []), finding]);
	}
	return found;
}
