/** What an offer asks of a person. */
import type { WayOffer } from '#lib/contract.ts';

/** Whether something has to be done at the station before anything can be taken. */
export function asksForHands(offer: WayOffer): boolean {
	return offer.physical.length > 0 || offer.online.length > 0 || offer.in_service.length > 0;
}

/** Whether there is something to be taken: starts, a wait, or corrections. */
export function canBeTaken(offer: WayOffer): boolean {
	return !asksForHands(offer) && (offer.errand !== null || offer.corrections.length > 0);
}

/** Whether it does nothing, and only says what is true of the product. */
export function onlySays(offer: WayOffer): boolean {
	return !asksForHands(offer) && offer.errand === null && offer.corrections.length > 0;
}

/** Whether it may be shown as what to do now: what is only said never is, for nobody but a person knows whether it is so. */
export function mayBeWanted(offer: WayOffer): boolean {
	return offer.corrections.length === 0 && !offer.only_if_checked;
}

/** Whether nothing has to be done but to go on. */
export function goesOn(offer: WayOffer): boolean {
	return !asksForHands(offer) && !canBeTaken(offer);
}

/** How an offer is told from the others, also when it is found again in a later state; `index` is its rank. */
export function keyOf(offer: WayOffer, index: number): string {
	return `${offer.kind} ${offer.title} ${index}`;
}
