/**
 * Each page is one prerendered document that is filled in the browser: without the stream there is nothing to show.
 */
import { askedSession, type Session } from '#lib/account/session.svelte.ts';
import { showKept } from '#lib/text/text.svelte.ts';

export const prerender = true;
export const ssr = false;

/**
 * The texts are there before anything is shown, so that nothing is in one language and a moment later in another; and who
 * is signed in, where the server says so at once, so that nothing is drawn that is then thrown away.
 */
export async function load(): Promise<{ readonly session: Session }> {
	const [session] = await Promise.all([askedSession(), showKept()]);
	return { session };
}
