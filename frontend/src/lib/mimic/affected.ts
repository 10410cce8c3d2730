/** What of the picture lights up with operations that have stopped: the parts they are about, and what stands there. */
import type { MimicPart, MimicSymbol, StationView } from '#lib/contract.ts';
import type { Stopped } from '#lib/operation/standing.ts';
import { indexOf, valuesIn, type Pictured } from './describe.ts';
import { valueOf, whereabouts } from './live.ts';

/** A variable, with its indices, and the value that a goal wants of it. */
const WANTED = /([\w.]+(?:\[[^\]]*\])?) == ([\w.-]+)/g;

/** Whether a part of the product is what a stopped operation has yet to change: its goal wants another value of it. */
export function isPartAffected({ variable }: MimicPart, { operations, variables }: Pictured, stopped: Stopped): boolean {
	const now = String(valueOf(variables, variable));
	return [...stopped.operations].some((name) =>
		[...(operations[name]?.goal ?? '').matchAll(WANTED)].some(([, wanted, value]) => wanted === variable && value !== now)
	);
}

/** Whether something stands where a stopped operation is carried out. */
export function standsAffected({ track }: MimicSymbol, { variables }: Pictured, stopped: Stopped): boolean {
	const at = track && whereabouts(track, variables, null);
	return at?.kind === 'there' && [...stopped.operations].some((name) => valuesIn(name).includes(at.to));
}

/** The variables by which a station that is outside its safe states differs from the nearest of them. */
export function outsideOf({ way_back: back }: Pick<StationView, 'way_back'>): ReadonlySet<string> {
	return new Set(back !== null && back.violated.length > 0 ? back.differences.map(({ name }) => name) : []);
}

/** Whether something is what it must not be, or where it must not be: its device, its place, and what is at that place. */
export function isOutside({ track, resource }: MimicSymbol, { variables }: Pictured, outside: ReadonlySet<string>): boolean {
	const at = track && whereabouts(track, variables, null);
	const about = (name: string): boolean => name === track?.position || (at?.kind === 'there' && indexOf(name) === at.to);
	return [...outside].some((name) => about(name) || (resource !== null && variables[name]?.resource === resource));
}
