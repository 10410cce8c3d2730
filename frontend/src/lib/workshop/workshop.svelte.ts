/**
 * The draft of the model as the server tells it: its files, its last change, and what its check has found so far. The same is
 * told of an example station.
 *
 * It is told only when it changes, so it is asked for again from time to time: what is not answered is not live.
 */
import { createContext } from 'svelte';
import type { ModelCheck, Workshop, WorkshopMessage } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { connect } from '#lib/stream/connection.ts';
import { undeployed } from './undeployed.svelte.ts';

/** Milliseconds between two questions whether the server is still there, and after which it is taken for gone. */
const ASK = 10_000;
const SILENT = 25_000;

export class WorkshopSeen {
	/** What was told last, live or not; null before the first. */
	view = $state.raw<Workshop | null>(null);
	/** Whether the stream is heard. */
	live = $state(false);
	/** Why nothing is known of the draft. */
	refusal = $state.raw<Refusal | null>(null);
	/** When the check was seen to be done, in seconds; null where it was done before, or is not. */
	checked = $state<number | null>(null);
	/** The example station that it is; null for the draft. */
	readonly example: string | null;

	constructor(example: string | null = null) {
		this.example = example;
	}

	/**
	 * Connects to the stream; the result disconnects. `told` is called with each message, and whether the draft is
	 * another one; `closed`, with the code, each time the connection is lost.
	 */
	attach(told: (isNew: boolean) => void, closed: (code: number) => void): () => void {
		let attached = true;
		const connection = connect<WorkshopMessage>(
			askedOf('/api/v1/model/stream', this.example),
			{
				opened: () => undefined,
				heard: (message) => {
					if (message.kind !== 'workshop') return;
					const before = this.view?.number;
					this.#see(this.view?.check ?? null, message.workshop.check);
					this.view = message.workshop;
					this.live = true;
					this.refusal = null;
					if (this.example === null) undeployed.hear(message.workshop);
					told(before !== message.workshop.number);
				},
				closed: (code) => {
					this.live = false;
					if (!attached) return;
					closed(code);
					if (this.view === null) void this.#ask();
				}
			},
			SILENT
		);
		const timer = setInterval(() => connection.resync(), ASK);
		return () => {
			attached = false;
			clearInterval(timer);
			connection.close();
		};
	}

	/** Several messages may tell of one check. */
	#see(before: ModelCheck | null, now: ModelCheck): void {
		if (now.state !== 'done') this.checked = null;
		else if (before !== null && (before.state !== 'done' || before.number !== now.number)) this.checked = Date.now() / 1000;
	}

	/** A handshake that is refused does not say why. */
	async #ask(): Promise<void> {
		const answer = await request<ModelCheck>('GET', askedOf('/api/v1/model/check', this.example));
		if (this.view === null) this.refusal = answer.ok ? null : answer.refusal;
	}
}

const [useWorkshop, setWorkshop] = createContext<WorkshopSeen>();
export { useWorkshop };

/** Makes it for all components below, unless the page has it already. */
export function provideWorkshop(seen = new WorkshopSeen()): WorkshopSeen {
	return setWorkshop(seen);
}
