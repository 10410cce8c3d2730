/** What a person should see to: archiving that does not work, files that are gone, a disk that fills up. */
import type { Storage } from '#lib/contract.ts';

export type Worry = { readonly kind: 'trouble' } | { readonly kind: 'missing' } | { readonly kind: 'full'; readonly days: number };

/** A disk that is full within so many days is worth a word now. */
export const SOON = 30;

export function worriesOf({ trouble, missing, growth }: Pick<Storage, 'trouble' | 'missing' | 'growth'>): readonly Worry[] {
	const found: Worry[] = [];
	if (trouble !== null) found.push({ kind: 'trouble' });
	if (missing > 0) found.push({ kind: 'missing' });
	const days = growth?.full_in ?? null;
	if (days !== null && days < SOON) found.push({ kind: 'full', days });
	return found;
}
