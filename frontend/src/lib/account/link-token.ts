/**
 * The token in the fragment of the link of the first start.
 *
 * A fragment is never sent to a server. It is taken out of the address bar and of this tab's history as soon as it is
 * read, and kept in memory only: loading the page anew needs the link anew.
 */

/** The token in `hash` (`#…`); null when it is none: only letters, digits, `-` and `_`, as links carry them. */
export function tokenOf(hash: string): string | null {
	const token = hash.replace(/^#/, '');
	return /^[\w-]{1,200}$/.test(token) ? token : null;
}

/** Takes the fragment out of the address bar and of the history; the token that it was. */
export function takeToken(): string | null {
	const { hash, pathname, search } = location;
	if (hash === '') return null;
	// SvelteKit keeps its own state in the entry; the address alone is changed.
	history.replaceState(history.state, '', pathname + search);
	return tokenOf(hash);
}
