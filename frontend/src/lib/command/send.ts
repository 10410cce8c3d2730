/**
 * Commands to the station: what a person asks for over REST.
 *
 * A command succeeds or is refused; a refusal carries words for the person. What a command did is never taken from its
 * answer: it shows in the stream.
 */
import type { Mode } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { command } from '#lib/rest/request.ts';

/** Changes the mode of execution. */
export function setMode(mode: Mode): Promise<Refusal | null> {
	return command('PUT', '/api/v1/mode', { body: { mode } });
}

/** Allows outputs to be published. */
export function startProduction(): Promise<Refusal | null> {
	return command('POST', '/api/v1/production/start', { body: {} });
}

/** Says that the task `id` is done as it was shown in `revision`. 404 or 409: it is gone. */
export function acknowledge(id: string, revision: number): Promise<Refusal | null> {
	return command('POST', `/api/v1/tasks/${encodeURIComponent(id)}/acknowledgement`, { body: { revision } });
}

/** Takes control over from the session `over`, null when nobody is believed to hold it. 409: another holds it by now. */
export function takeControl(over: string | null, reason: string): Promise<Refusal | null> {
	const why = reason.trim();
	return command('PUT', '/api/v1/control', { body: why === '' ? { over } : { over, reason: why } });
}

/** Gives control back: nobody holds it then. */
export function releaseControl(): Promise<Refusal | null> {
	return command('DELETE', '/api/v1/control');
}
