/** Where in a predicate the backend's parser has stopped, from the words of its refusal. */
import type { Refusal } from '#lib/rest/refusal.ts';

export interface Place {
	readonly start: number;
	readonly end: number;
	readonly message: string;
}

const WORDS = /^character (\d+)(?:, `([^]*?)`)?: ([^]*)$/;

/** The place in `predicate` that `refusal` names; null where it names none, or not one of this text. */
export function placeOf(refusal: Refusal | null, predicate: string): Place | null {
	const found = refusal?.kind === 'bad-predicate' ? WORDS.exec(refusal.detail) : null;
	if (!found) return null;
	const start = Number(found[1]) - 1;
	const part = found[2] ?? '';
	const message = found[3] ?? '';
	if (start < 0 || start > predicate.length || !predicate.startsWith(part, start)) return null;
	return { start, end: start + part.length, message };
}
