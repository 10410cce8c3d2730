/** How far a key has come, and how it is used. */
import type { Key, KeyScope } from '#lib/contract.ts';

export type Standing = 'valid' | 'expired' | 'revoked';

/** Whether `key` is of use at `now`, in seconds since the epoch. */
export function standingOf(key: Key, now: number): Standing {
	if (key.revoked !== null) return 'revoked';
	return key.expires <= now ? 'expired' : 'valid';
}

/** What a key of each scope can read, the most telling first. */
const READS = { read: 'station', audit: 'audit', 'orders-read': 'job-orders' } as const satisfies Partial<Record<KeyScope, string>>;

/**
 * A command line that reads something with a key that is kept in the variable `KEY`, from the server at `origin`. The secret
 * is not one of its arguments, which everybody on the machine may read.
 */
export function example(scopes: readonly KeyScope[], origin: string): string {
	const address = Object.entries(READS).find(([scope]) => scopes.some((each) => each === scope))?.[1] ?? 'job-orders';
	return `curl --header @- ${origin}/api/v1/${address} <<< "Authorization: Bearer $KEY"`;
}
