/** What is kept of ways that were found before, where a later search was cut short. */
import type { AdviceAnswer, WayOffer } from '#lib/contract.ts';
import { meaningOf } from './offer.ts';

/** The later answer; of the same state and not complete, with what an earlier one had found and it has not, after its own. */
export function merged(earlier: AdviceAnswer | null, later: AdviceAnswer): AdviceAnswer {
	if (earlier === null || later.complete || earlier.revision !== later.revision) return later;
	const found = new Set([...later.offers, ...later.if_checked].map(meaningOf));
	const withKept = (own: readonly WayOffer[], before: readonly WayOffer[]): WayOffer[] => [
		...own,
		...before.filter((offer) => !found.has(meaningOf(offer)))
	];
	const offers = withKept(later.offers, earlier.offers);
	// Why there is none is said only where there is none.
	return { ...later, offers, if_checked: withKept(later.if_checked, earlier.if_checked), reasons: offers.length > 0 ? null : later.reasons };
}
