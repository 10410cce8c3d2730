/** How far a key has come, and how it is used. */
import type { Key, KeyScope } from '#lib/contract.ts';

export type Standing = 'valid' | 'expired' | 'revoked';

/** Whether `key` is of use at `now`, in seconds since the epoch. */
export function standingOf(key: Key, now: number): Standing {
	if (key.revoked !== null) return 'revoked';
	return key.expires <= now ? 'expired' : 'valid';
}

/**
 * A command line that reads something with a key that is kept in the variable `KEY`, from the server at `origin`. The secret
 * is not one of its arguments, which everybody on the machine may read.
 */
export function example(scopes: readonly KeyScope[], origin: string): string {
	const address = scopes.includes('read') ? '/api/v1/station' : scopes.includes('audit') ? '/api/v1/audit' : '/metrics';
	return `curl --header @- ${origin}${address} <<< "Authorization: Bearer $KEY"`;
}
