/** The page that is called Review changes now: older links lead on. */
import { redirect } from '@sveltejs/kit';
import { REVIEW } from '#lib/account/way.ts';

export function load(): never {
	redirect(308, REVIEW);
}
