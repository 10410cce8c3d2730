/** Revisions have no numbers of their own: they are counted, the oldest as the first. */
import type { Revision, Revisions } from '#lib/contract.ts';

/** The number of a revision; null where it is none of these. */
export function numberOf(revisions: Pick<Revisions, 'revisions'>, id: string): number | null {
	const place = revisions.revisions.findIndex((each) => each.id === id);
	return place < 0 ? null : revisions.revisions.length - place;
}

/** The revision that the station runs; null where it is none of these. */
export function runningOne(revisions: Revisions | null): Revision | null {
	return revisions?.revisions.find((each) => each.running) ?? null;
}

/** What a change is called: the first line of what was said of it, or else the name it was saved under. */
export function titleOfChange({ name, message }: Pick<Revision, 'name' | 'message'>): string {
	return message.split('\n')[0]?.trim() || name;
}
