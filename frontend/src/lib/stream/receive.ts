/**
 * What a client knows after each message of the stream.
 *
 * The server sends one snapshot and then numbered deltas. A delta means something only on top of the one before it,
 * so a message whose number does not follow is a *gap*: it is not applied, and nothing after it is, until a new
 * snapshot comes. The document known so far is kept, because old values marked as old are more use than none.
 */
import { MAPS, type Delta, type StationView, type StreamMessage } from '#lib/contract.ts';

export interface Stream {
	/** Number of the last message that was applied; null before the first snapshot. */
	readonly sequence: number | null;
	readonly view: StationView | null;
	/** Whether the server hears the controller. */
	readonly controller: 'heard' | 'lost';
	/** A message is missing: a snapshot must be asked for. */
	readonly gap: boolean;
	/** What the server last found wrong with this connection, in words. */
	readonly trouble: string | null;
}

export const NOTHING: Stream = { sequence: null, view: null, controller: 'heard', gap: false, trouble: null };

/** The document after a delta. What did not change keeps its identity. */
export function apply(view: StationView, delta: Pick<Delta, 'changed' | 'removed'>): StationView {
	const next: StationView = { ...view, ...delta.changed };
	for (const field of MAPS) {
		const changed = delta.changed[field];
		const removed = delta.removed[field];
		if (changed === undefined && removed === undefined) continue;
		const entries: Record<string, unknown> = { ...view[field], ...changed };
		for (const key of removed ?? []) delete entries[key];
		Object.assign(next, { [field]: entries });
	}
	return next;
}

/** What is known after `message`. */
export function receive(stream: Stream, message: StreamMessage): Stream {
	switch (message.kind) {
		case 'snapshot':
			return { ...NOTHING, sequence: message.sequence, view: message.view };
		case 'delta':
			if (stream.view === null || stream.sequence === null || stream.gap) return stream;
			if (message.sequence !== stream.sequence + 1) return { ...stream, gap: true };
			return { ...stream, sequence: message.sequence, view: apply(stream.view, message) };
		case 'link':
			if (stream.sequence === null || stream.gap) return { ...stream, controller: message.controller };
			// The server numbers this message like a delta; to one who asks while it hears nothing it repeats the last number.
			if (message.sequence !== stream.sequence && message.sequence !== stream.sequence + 1)
				return { ...stream, controller: message.controller, gap: true };
			return { ...stream, sequence: message.sequence, controller: message.controller };
		case 'error':
			return { ...stream, trouble: message.detail };
	}
}
