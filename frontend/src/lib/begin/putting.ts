/** How what was written comes into the draft: the documents as one change, and then the topics of devices on the network. */
import type { Attachment } from '#lib/contract.ts';
import type { Draft } from '#lib/model/draft.svelte.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { arrival, type Begun } from './begun.svelte.ts';
import { editsOf } from './edits.ts';
import type { Sketch } from './sketch.ts';

/** Milliseconds in which a topic is looked at on the network and tried in the model. */
const PATIENCE = 65_000;

/**
 * Puts it there; why not, or null. Then `arrival` has what is told of it. `doing` is told which of how many topics is taken
 * in: one that cannot be is told, and keeps none of the others back.
 */
export async function put(
	draft: Draft,
	files: Readonly<Record<string, string>>,
	sketch: Pick<Sketch, 'title' | 'devices'>,
	doing: (topic: number, of: number) => void
): Promise<Refusal | null> {
	const title = say().begin.put.change(sketch.title.trim());
	const refusal = await draft.change(title, editsOf(files, draft.files));
	if (refusal !== null) return refusal;
	const wanted = sketch.devices.flatMap(({ kind, name, topics }) => (kind === 'found' ? topics.map((topic) => ({ topic, resource: name })) : []));
	const failed: Begun['failed'][number][] = [];
	for (const [at, body] of wanted.entries()) {
		doing(at + 1, wanted.length);
		const why = await attach(body);
		if (why !== null) failed.push({ topic: body.topic, why });
	}
	arrival.now = { title, failed, isLast: failed.length === wanted.length };
	return null;
}

/** Takes a topic in for a device; why not, or null. */
async function attach(body: { readonly topic: string; readonly resource: string }): Promise<string | null> {
	const answer = await request<Attachment>('POST', '/api/v1/ros/attachments', { body, patience: PATIENCE });
	if (!answer.ok) return answer.refusal.detail;
	if (answer.value.made) return null;
	return answer.value.findings.map(({ message, said }) => told(said, message)).join(' ') || say().begin.put.notMade;
}
