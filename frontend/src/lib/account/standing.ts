/**
 * What this page knows of its own session, and what each event makes of it.
 *
 * The server alone knows whether a session lives. While it has not answered, nothing of the station is shown (`asking`);
 * once it has, a server that is not reached changes nothing: the view then says by itself that it is no longer live.
 */
import type { SessionAnswer } from '#lib/contract.ts';

export type Standing =
	| { readonly state: 'asking'; readonly trouble: string | null }
	| { readonly state: 'known'; readonly answer: SessionAnswer };

/** Nothing is known yet, or no longer. */
export const ASKING: Standing = { state: 'asking', trouble: null };

export type Event =
	/** The server has said how it is. */
	| { readonly kind: 'answered'; readonly answer: SessionAnswer }
	/** The server did not say; `why` in words. */
	| { readonly kind: 'unanswered'; readonly why: string }
	/** The session ended somewhere else, or the page leaves the front for good: nothing may stay in sight. */
	| { readonly kind: 'doubted' };

/** What is known after `event`. */
export function after(standing: Standing, event: Event): Standing {
	switch (event.kind) {
		case 'answered':
			return { state: 'known', answer: event.answer };
		case 'unanswered':
			return standing.state === 'known' ? standing : { state: 'asking', trouble: event.why };
		case 'doubted':
			return standing.state === 'asking' ? standing : ASKING;
	}
}
