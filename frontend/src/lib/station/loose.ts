/** What of a model is tied to nothing: named without being there, made by nothing, or needed by nothing. */
import type { Manner, Thing, Whole } from './graph.ts';
import { isPiece, reached } from './graph.ts';

export const LOOSE = ['missing', 'unfed', 'unsent', 'unwritten', 'unneeded'] as const;
export type Loose = (typeof LOOSE)[number];

/** What a station is for: all else is needed for these. */
const PURPOSES: ReadonlySet<string> = new Set(['station', 'work_master', 'operation', 'specification', 'alarm']);
const TO_ROS: ReadonlySet<string> = new Set(['topic', 'service', 'action']);
const WRITING: readonly Manner[] = ['writes', 'effect', 'feeds', 'brings', 'commands'];

/** Why each piece is a loose end; what is none is not there. Of several reasons the first that comes to mind. */
export function looseEnds(whole: Whole): Map<number, Loose> {
	const purposes = whole.things.filter(({ kind }) => PURPOSES.has(kind)).map(({ index }) => index);
	const needed = reached(whole.down, purposes);
	const has = (thing: Thing, manners: readonly Manner[]): boolean =>
		(whole.usedBy[thing.index] ?? []).some(({ manner }) => manners.includes(manner));
	const sends = (thing: Thing): boolean => (whole.uses[thing.index] ?? []).some(({ manner }) => manner === 'sends');

	function why(thing: Thing): Loose | null {
		if (thing.standing === 'missing') return 'missing';
		if (PURPOSES.has(thing.kind)) return null;
		// What a person acknowledges comes from a watch or from the page.
		if (thing.section === 'measured' && !has(thing, ['feeds', 'acknowledgement'])) return 'unfed';
		if (thing.section === 'output' && !has(thing, ['sends'])) return 'unsent';
		if (thing.section === 'estimated' && !has(thing, WRITING)) return 'unwritten';
		if (thing.kind === 'enumeration' || thing.kind === 'message') return used(thing) ? null : 'unneeded';
		if (needed.has(thing.index) || (TO_ROS.has(thing.kind) && sends(thing))) return null;
		return 'unneeded';
	}
	/** Of what is within, too: values of enumerations are named without these. */
	const used = ({ index }: Thing): boolean =>
		[index, ...(whole.inside[index] ?? [])].some((each) =>
			(whole.usedBy[each] ?? []).some((tie) => whole.pieceOf[tie.by] !== index)
		);

	const found = new Map<number, Loose>();
	for (const thing of whole.things) {
		const reason = isPiece(thing) ? why(thing) : null;
		if (reason !== null) found.set(thing.index, reason);
	}
	return found;
}
