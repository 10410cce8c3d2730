/** Why the server did not do what was asked, in words for a person (RFC 9457). */
import type { TextPlace, Problem } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';

export interface Refusal {
	readonly title: string;
	readonly detail: string;
	/** HTTP status; null when the server was not reached. */
	readonly status: number | null;
	/** What kind of refusal it is, as in `task-gone`; null when the answer does not say. */
	readonly kind: string | null;
	/** Seconds after which to try again makes sense; null when the answer does not say. */
	readonly retryAfter: number | null;
	/** What is wrong within a text that was sent, and where; null when the answer names no place. */
	readonly place: TextPlace | null;
}

const PROBLEMS = '/problems/';
const LONGEST_WAIT = 24 * 60 * 60;

/** The kind of what was sent and not answered in time: whether it was done is not known. */
export const NO_ANSWER = 'no-answer';
const NOTHING = { status: null, kind: null, retryAfter: null, place: null };

/** Nothing came back from an act, as it did not get there, or was not answered in time. */
export function unreached(error?: unknown): Refusal {
	const texts = say().door.refusal;
	const late = error instanceof DOMException && (error.name === 'TimeoutError' || error.name === 'AbortError');
	if (late) return { title: texts.noAnswer, detail: texts.noAnswerWhy, ...NOTHING, kind: NO_ANSWER };
	return { title: texts.notSent, detail: texts.notSentWhy, ...NOTHING };
}

/** Nothing came back from a question, which changes nothing. */
export function unread(): Refusal {
	return { title: say().door.refusal.notRead, detail: say().door.refusal.notReached, ...NOTHING };
}

/** The seconds that a `Retry-After` header stands for; null when it says none. */
function secondsOf(header: string | null): number | null {
	const seconds = header === null || header.trim() === '' ? NaN : Number(header);
	return Number.isFinite(seconds) && seconds > 0 ? Math.min(Math.ceil(seconds), LONGEST_WAIT) : null;
}

/** The refusal that an answer of `status` with the text `body` and the header `Retry-After` stands for. */
export function refusalOf(status: number, body: string, retryAfter: string | null = null): Refusal {
	let problem: Partial<Problem> = {};
	try {
		const parsed: unknown = JSON.parse(body);
		if (typeof parsed === 'object' && parsed !== null) problem = parsed;
	} catch {
		// Not a problem document: something between us and the station answered, and its status must do.
	}
	const title = typeof problem.title === 'string' ? told(problem.title_message, problem.title) : say().door.refusal.refused;
	const detail = typeof problem.detail === 'string' ? told(problem.detail_message, problem.detail) : say().door.refusal.status(status);
	const type = typeof problem.type === 'string' ? problem.type : '';
	const kind = type.startsWith(PROBLEMS) ? type.slice(PROBLEMS.length) : null;
	return { title, detail, status, kind, retryAfter: secondsOf(retryAfter), place: problem.place ?? null };
}
