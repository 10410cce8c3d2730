/** What is wrong with the name of a revision before it is sent; the server has the last word. */
import type { Revision } from '#lib/contract.ts';

export const LONGEST_NAME = 100;

export type NameTrouble =
	| { readonly why: 'empty' | 'long' }
	/** There is a revision of that name, or the last one is the same as what would be saved. */
	| { readonly why: 'taken' | 'same'; readonly name: string };

/** What keeps the draft from being saved as `name` beside `revisions`, newest first; null where nothing does. */
export function nameTrouble(name: string, revisions: readonly Revision[]): NameTrouble | null {
	const [last] = revisions;
	if (last?.draft) return { why: 'same', name: last.name };
	const plain = name.trim().replaceAll(/\s+/g, ' ');
	if (plain === '') return { why: 'empty' };
	if ([...plain].length > LONGEST_NAME) return { why: 'long' };
	return revisions.some((each) => each.name === plain) ? { why: 'taken', name: plain } : null;
}
