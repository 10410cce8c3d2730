/**
 * Commands to the station: what a person asks for over REST.
 *
 * A command succeeds or is refused; a refusal carries words for the person (RFC 9457). What a command did is never
 * taken from its answer: it shows in the stream.
 */
import type { Mode, Problem } from '#lib/contract.ts';

export interface Refusal {
	readonly title: string;
	readonly detail: string;
	/** HTTP status; null when the server was not reached. */
	readonly status: number | null;
}

/** Milliseconds after which an answer is no longer waited for. */
const PATIENCE = 5000;

const UNREACHED: Refusal = {
	title: 'Not sent',
	detail: 'The server cannot be reached. Nothing may have been done; look at the station before you try again.',
	status: null
};

/** The refusal that an answer of `status` with the text `body` stands for. */
export function refusalOf(status: number, body: string): Refusal {
	let problem: Partial<Problem> = {};
	try {
		const parsed: unknown = JSON.parse(body);
		if (typeof parsed === 'object' && parsed !== null) problem = parsed;
	} catch {
		// Not a problem document: something between us and the station answered, and its status must do.
	}
	const title = typeof problem.title === 'string' ? problem.title : 'Refused';
	const detail = typeof problem.detail === 'string' ? problem.detail : `The server answered with status ${status}.`;
	return { title, detail, status };
}

async function send(method: 'PUT' | 'POST', path: string, body: object): Promise<Refusal | null> {
	try {
		const answer = await fetch(path, {
			method,
			headers: { 'Content-Type': 'application/json' },
			body: JSON.stringify(body),
			signal: AbortSignal.timeout(PATIENCE)
		});
		return answer.ok ? null : refusalOf(answer.status, await answer.text());
	} catch {
		return UNREACHED;
	}
}

/** Changes the mode of execution. */
export function setMode(mode: Mode): Promise<Refusal | null> {
	return send('PUT', '/api/v1/mode', { mode });
}

/** Allows outputs to be published. */
export function startProduction(): Promise<Refusal | null> {
	return send('POST', '/api/v1/production/start', {});
}

/** Says that the task `id` is done as it was shown in `revision`. 404 or 409: it is gone. */
export function acknowledge(id: string, revision: number): Promise<Refusal | null> {
	return send('POST', `/api/v1/tasks/${encodeURIComponent(id)}/acknowledgement`, { revision });
}
