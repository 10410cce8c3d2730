/** What of the picture lights up with operations that have stopped: the parts they are about, and what stands there. */
import type { MimicPart, MimicSymbol } from '#lib/contract.ts';
import type { Stopped } from '#lib/operation/standing.ts';
import { valuesIn, type Pictured } from './describe.ts';
import { valueOf, whereabouts } from './live.ts';

/** Whether a part of the product is what a stopped operation has yet to change: its goal wants another value of it. */
export function isPartAffected({ variable }: MimicPart, { operations, variables }: Pictured, stopped: Stopped): boolean {
	const wanted = `${variable} == `;
	return [...stopped.operations].some((name) => {
		const goal = operations[name]?.goal ?? '';
		const at = goal.indexOf(wanted);
		const rest = goal.slice(at + wanted.length);
		return at >= 0 && rest.match(/^[\w.-]+/)?.[0] !== String(valueOf(variables, variable));
	});
}

/** Whether something stands where a stopped operation is carried out. */
export function standsAffected({ track }: MimicSymbol, { variables }: Pictured, stopped: Stopped): boolean {
	const at = track && whereabouts(track, variables, null);
	return at?.kind === 'there' && [...stopped.operations].some((name) => valuesIn(name).includes(at.to));
}
