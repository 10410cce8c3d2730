/**
 * Requests to the server: JSON there, JSON back, and every refusal in words.
 *
 * The session is a cookie that this page cannot read; the browser sends it. Whoever wants to know that the server has
 * found it ended listens with `whenSignedOut`.
 */
import type { Address } from '#lib/contract.ts';
import { readRefusals } from '#lib/text/text.svelte.ts';
import { titled } from '#lib/wording/titled.svelte.ts';
import { refusalOf, unreached, unread, type Refusal } from './refusal.ts';

type Method = 'GET' | 'POST' | 'PUT' | 'PATCH' | 'DELETE';

export interface Rest {
	/** Sent as JSON. */
	readonly body?: object;
	/** Sent as it is, piece by piece. */
	readonly file?: Blob;
	/** The revision that the change was made upon, in double quotes. */
	readonly ifMatch?: string;
	/** What is sent again with the same is done once. */
	readonly idempotencyKey?: string;
	/** Milliseconds after which an answer is no longer waited for. */
	readonly patience?: number;
	/** Aborted when the answer is no longer waited for, where `patience` does not say all of that. */
	readonly signal?: AbortSignal;
}

export type Answer<Value> =
	| {
			readonly ok: true;
			readonly value: Value;
			readonly etag: string | null;
			/** Seconds by which the server's clock is ahead of this device's. */
			readonly ahead: number;
	  }
	| { readonly ok: false; readonly refusal: Refusal };

/** What is edited there is a draft, and stays as it is written. */
const DRAFT = '/api/v1/model/';
/** Milliseconds after which an answer is no longer waited for, unless the request says otherwise. */
const PATIENCE = 5000;

const listeners = new Set<() => void>();

/** Calls `listener` whenever the server answers that nobody is signed in; the result stops that. */
export function whenSignedOut(listener: () => void): () => void {
	listeners.add(listener);
	return () => listeners.delete(listener);
}

/** Seconds by which the clock behind a `Date` header is ahead of `now` (ms); the header tells no less than a second. */
export function aheadOf(header: string | null, now: number): number {
	const difference = header === null ? NaN : Date.parse(header) - now;
	return Math.abs(difference) > 1000 ? difference / 1000 : 0;
}

/** Sends one request. `Value` is what the contract says of its answer; undefined where that has no content. */
export async function request<Value = undefined>(
	method: Method,
	path: Address,
	{ body, file, ifMatch, idempotencyKey, patience = PATIENCE, signal = AbortSignal.timeout(patience) }: Rest = {}
): Promise<Answer<Value>> {
	const headers: Record<string, string> = {};
	if (body !== undefined) headers['Content-Type'] = 'application/json';
	if (file !== undefined) headers['Content-Type'] = 'application/octet-stream';
	if (ifMatch !== undefined) headers['If-Match'] = ifMatch;
	if (idempotencyKey !== undefined) headers['Idempotency-Key'] = idempotencyKey;
	try {
		const sent = file !== undefined ? { body: file } : body === undefined ? {} : { body: JSON.stringify(body) };
		const answer = await fetch(path, { method, headers, signal, ...sent });
		const text = await answer.text();
		if (answer.ok) {
			const read = (text === '' ? undefined : JSON.parse(text)) as Value;
			const value = path.startsWith(DRAFT) ? read : titled(read);
			const ahead = aheadOf(answer.headers.get('Date'), Date.now());
			return { ok: true, value, etag: answer.headers.get('ETag'), ahead };
		}
		await readRefusals();
		const refusal = refusalOf(answer.status, text, answer.headers.get('Retry-After'));
		if (refusal.kind === 'signed-out') for (const listener of listeners) listener();
		return { ok: false, refusal };
	} catch (error) {
		return { ok: false, refusal: method === 'GET' ? unread() : unreached(error) };
	}
}

/** Sends a command of which only the refusal matters; null when it was accepted. */
export async function command(
	method: Exclude<Method, 'GET'>,
	path: Address,
	rest: Rest = {}
): Promise<Refusal | null> {
	const answer = await request(method, path, rest);
	return answer.ok ? null : answer.refusal;
}
