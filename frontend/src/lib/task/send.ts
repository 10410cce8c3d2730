/** What a person says of a task over REST, as in `command/send.ts`. It is apart from that as a watch needs nothing else. */
import type { ProblemKind } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { command } from '#lib/rest/request.ts';

/** Says that the task `id` is done as it was shown in `revision`. 404 or 409: it is gone. */
export function acknowledge(id: string, revision: number): Promise<Refusal | null> {
	return command('POST', `/api/v1/tasks/${encodeURIComponent(id)}/acknowledgement`, { body: { revision } });
}

/** Says that the task `id` cannot be done as it was shown in `revision`. 404 or 409: it is gone. */
export function reportProblem(
	id: string,
	revision: number,
	what: ProblemKind | null,
	reason: string
): Promise<Refusal | null> {
	const why = reason.trim();
	const body = why === '' ? { revision, what } : { revision, what, reason: why };
	return command('POST', `/api/v1/tasks/${encodeURIComponent(id)}/problem`, { body });
}

/** Says that it can be done after all. */
export function solveProblem(id: string, revision: number): Promise<Refusal | null> {
	return command('POST', `/api/v1/tasks/${encodeURIComponent(id)}/problem/solved`, { body: { revision } });
}
