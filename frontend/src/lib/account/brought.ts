/** What a provider has sent back with the browser, in the query of the address (RFC 6749, 4.1.2; RFC 9207). */

export interface Brought {
	readonly state: string;
	readonly code?: string;
	readonly error?: string;
	readonly iss?: string;
}

/** What stands in `search`; null where nothing does that a provider has sent. An error that is no code of one is `unknown_error`. */
export function broughtBack(search: string): Brought | null {
	const parameters = new URLSearchParams(search);
	const state = parameters.get('state');
	const [code, error, iss] = ['code', 'error', 'iss'].map((name) => parameters.get(name) || undefined);
	if (!state || (code === undefined && error === undefined)) return null;
	if (error !== undefined)
		return { state, error: /^[a-z_]{1,60}$/.test(error) ? error : 'unknown_error', ...(iss && { iss }) };
	return { state, ...(code && { code }), ...(iss && { iss }) };
}
