/** What an offer asks of a person. */
import type { StationView, WayOffer } from '#lib/contract.ts';

/** Whether something has to be done at the station before anything can be taken. */
export function asksForHands(offer: WayOffer): boolean {
	return offer.physical.length > 0 || offer.online.length > 0 || offer.in_service.length > 0;
}

/** Whether the station goes on by itself as soon as a person has done it: whoever goes in holds it first. */
export function goesOnMeanwhile({ physical, online }: WayOffer, { mode, production }: Pick<StationView, 'mode' | 'production'>): boolean {
	return physical.length + online.length > 0 && mode === 'automatic' && production === 'started';
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

/** Whether something speaks against what is believed: it does not fit what is measured, or nobody has seen since that it is still so. */
export function isDoubted({ questions, variables }: Pick<StationView, 'questions' | 'variables'>, name: string): boolean {
	return questions.some(({ variable }) => variable === name) || (variables[name]?.belief?.unconfirmed_since ?? null) !== null;
}

/** Whether what it is to bring about is so as it is: nothing is started for it, and nothing waited for. */
export function isSoAlready({ errand }: Pick<WayOffer, 'errand'>): boolean {
	return errand !== null && errand.steps.length === 0 && errand.ticks === 0;
}

/** Whether nothing has to be done but to go on. */
export function goesOn(offer: WayOffer): boolean {
	return !asksForHands(offer) && !canBeTaken(offer);
}

/** What it asks for, whatever number it has: two of the same meaning are the same way, also when it is found again in a later state. */
export function meaningOf({ kind, operation, title, online, in_service, physical, corrections }: WayOffer): string {
	const values = (changes: WayOffer['physical']): string[] => changes.map(({ name, then }) => `${name} ${JSON.stringify(then)}`).sort();
	return JSON.stringify([kind, operation, title, [...online].sort(), [...in_service].sort(), values(physical), values(corrections)]);
}
