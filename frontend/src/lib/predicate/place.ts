/** Where in a predicate the backend's parser has stopped. */
import type { TextPlace } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';

/** The place in `predicate` that `refusal` names, as this language counts; null where it names none, or not one of this text. */
export function placeOf(refusal: Refusal | null, predicate: string): TextPlace | null {
	const place = refusal?.place ?? null;
	const characters = [...predicate];
	if (place === null || place.start < 0 || place.end < place.start || place.end > characters.length) return null;
	const length = (to: number): number => characters.slice(0, to).join('').length;
	return { start: length(place.start), end: length(place.end), message: place.message };
}
