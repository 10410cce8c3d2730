/** Which of the ways is the chosen one, also after they were looked for again. */
import type { AdviceAnswer, WayOffer } from '#lib/contract.ts';
import { mayBeWanted, meaningOf } from './offer.ts';

/** A way with what tells it from the others. */
export type Way = readonly [key: string, offer: WayOffer];

export interface Choice {
	readonly chosen: Way | null;
	/** What a person has chosen is not offered any more: they choose anew, nobody does it for them. */
	readonly lost: boolean;
}

/** All ways of an answer, those last that hold only if somebody has checked. */
export function waysOf(answer: AdviceAnswer | null): Way[] {
	return [...keyed('', answer?.offers ?? []), ...keyed('checked ', answer?.if_checked ?? [])];
}

/** By its meaning; by its rank only among those that mean the same. */
function keyed(group: string, offers: readonly WayOffer[]): Way[] {
	const times = new Map<string, number>();
	return offers.map((offer) => {
		const meaning = meaningOf(offer);
		const before = times.get(meaning) ?? 0;
		times.set(meaning, before + 1);
		return [`${group}${meaning} ${before}`, offer];
	});
}

/** What a person has `picked`; as long as that is nothing, the first, unless it only says what nobody but a person knows. */
export function choiceOf(ways: readonly Way[], picked: string | null): Choice {
	if (picked !== null) {
		const chosen = ways.find(([key]) => key === picked) ?? null;
		return { chosen, lost: chosen === null };
	}
	const [first] = ways;
	return { chosen: first && mayBeWanted(first[1]) ? first : null, lost: false };
}
