/**
 * Each page is one prerendered document that is filled in the browser: without the stream there is nothing to show.
 */
import { showKept } from '#lib/text/text.svelte.ts';

export const prerender = true;
export const ssr = false;

/** The texts are there before anything is shown, so that nothing is in one language and a moment later in another. */
export function load(): Promise<void> {
	return showKept();
}
