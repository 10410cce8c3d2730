/**
 * Which page a person is led to instead of the one that was asked for.
 *
 * A page that needs a session leads to the sign-in and back again (`to`). What stands in `to` came with the address and
 * may be anybody's: only an address on this server is ever followed.
 */
import type { SessionAnswer } from '#lib/contract.ts';

export const HOME = '/';
export const SIGN_IN = '/sign-in';
/** Where a provider sends the browser back to. */
export const FROM_PROVIDER = '/sign-in/provider';
export const FIRST_START = '/setup';
export const ACCOUNT = '/account';
/** What has changed in the draft, and how it comes to the station; older links say `/deploy`. */
export const REVIEW = '/review';
/** Shown on a screen that nobody touches. */
export const WALL = '/wall';
/** The watch has a credential of its own, and pairs itself where it has none. */
export const WATCH = '/operator';

/** Any origin serves to resolve an address; this one can belong to nobody. */
const HERE = 'https://here.invalid';

/**
 * The path and query that `to` stands for if it leads to a page of this server, else the start page.
 *
 * Browsers read `\` as `/`, drop tabs and line ends within an address and blanks around it, and take `//name` for another
 * server; so whatever is not plainly a path is not followed, and what is left must resolve to this origin. The pages that
 * only make sense signed out lead to the start page too.
 */
export function returnAddress(to: string | null): string {
	if (to === null || !/^\/(?![/\\])/.test(to) || /[\\\u0000-\u0020\u007f]/.test(to)) return HOME;
	let url: URL;
	try {
		url = new URL(to, HERE);
	} catch {
		return HOME;
	}
	// Dots are taken out of a path as it is resolved, so that `/.//name` is only now seen to be `//name`.
	if (url.origin !== HERE || url.pathname.startsWith('//')) return HOME;
	return [SIGN_IN, FROM_PROVIDER, FIRST_START].includes(url.pathname) ? HOME : url.pathname + url.search;
}

/** The sign-in that leads back to `page` (path and query). */
export function signInAddress(page: string): string {
	const to = returnAddress(page);
	return to === HOME ? SIGN_IN : `${SIGN_IN}?to=${encodeURIComponent(to)}`;
}

/** The part of an address that decides. */
export interface Asked {
	readonly pathname: string;
	readonly search: string;
}

/** Where one is led who asks for `url` with the session `answer`; null: that page may be shown. */
export function leadsTo(answer: SessionAnswer, url: Asked): string | null {
	const at = (page: string): boolean => url.pathname === page;
	const elsewhere = (page: string): string | null => (at(page) ? null : page);
	switch (answer.state) {
		case 'first-start':
			if (at(WATCH) || at(FROM_PROVIDER) || at(FIRST_START)) return null;
			if (!answer.people) return FIRST_START;
			return at(SIGN_IN) ? null : signInAddress(url.pathname + url.search);
		case 'signed-out':
			return at(SIGN_IN) || at(FROM_PROVIDER) || at(FIRST_START) || at(WATCH) ? null : signInAddress(url.pathname + url.search);
		case 'signed-in':
			if (answer.must_change_password) return elsewhere(ACCOUNT);
			if (at(FIRST_START)) return HOME;
			return at(SIGN_IN) ? returnAddress(new URLSearchParams(url.search).get('to')) : null;
	}
}
