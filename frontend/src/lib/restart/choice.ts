/** Which of the ways is the chosen one, also after they were looked for again. */
import type { AdviceAnswer, StationView, WayOffer } from '#lib/contract.ts';
import { isDoubted, mayBeWanted, meaningOf } from './offer.ts';

/** A way with what tells it from the others. */
export type Way = readonly [key: string, offer: WayOffer];

export interface Choice {
	readonly chosen: Way | null;
	/** What a person has chosen is not offered any more: they choose anew, nobody does it for them. */
	readonly lost: boolean;
}

/** The ways of an answer, least effort first. */
export interface Ways {
	readonly offered: readonly Way[];
	/** What is for those alone who have checked: it says what nobody did, or changes what nothing speaks against. */
	readonly checked: readonly Way[];
}

export function waysOf(answer: AdviceAnswer | null, view: Pick<StationView, 'questions' | 'variables'>): Ways {
	const offers = keyed('', answer?.offers ?? []);
	const isOffered = ([, { corrections }]: Way): boolean => corrections.every(({ name }) => isDoubted(view, name));
	return {
		offered: offers.filter(isOffered),
		checked: [...offers.filter((way) => !isOffered(way)), ...keyed('checked ', answer?.if_checked ?? [])]
	};
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
