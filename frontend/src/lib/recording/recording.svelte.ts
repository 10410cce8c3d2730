/**
 * A recording of ROS 2 traffic that somebody brings, and the moment of it that is looked at.
 *
 * The server keeps it for a while and reads it with the draft; here are its moments, some thousands at once, and the state at
 * one of them.
 */
import type { RecordedMoment, RecordedState, Recording } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { indexAt } from './moments.ts';

const ADDRESS = '/api/v1/model/recordings';
/** Milliseconds in which a recording is sent and read: as long as the server waits for it, and somewhat more. */
const SENT = 1_200_000;
/** Milliseconds: the server prepares the draft first. */
const PATIENCE = 120_000;
/** Milliseconds after which the state is asked for, where somebody goes quickly through the moments. */
const SETTLED = 120;

export class RecordingDesk {
	view = $state.raw<Recording | null>(null);
	/** Seconds after the beginning: the moment that is looked at. */
	at = $state(0);
	state = $state.raw<RecordedState | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** What the file is called that is on its way; null where none is. */
	coming = $state<string | null>(null);
	/** Moments or a state are asked for. */
	pending = $state(false);
	#asked = 0;
	#asking: AbortController | null = null;
	#timer: ReturnType<typeof setTimeout> | null = null;

	readonly moments: readonly RecordedMoment[] = $derived(this.view?.moments ?? []);
	/** The last moment by then, by its place among those that are here; -1 before the first. */
	readonly index = $derived(indexAt(this.moments, this.at));
	readonly moment = $derived(this.moments[this.index] ?? null);
	/** What is missing, or was not read. */
	readonly lacks = $derived(
		this.view === null ? 0 : this.view.missing.length + this.view.otherwise.length + this.view.troubles.length + (this.view.incomplete === null ? 0 : 1)
	);
	/** The part of the recording of which the moments are here. */
	readonly span = $derived.by(() => {
		const { view, moments } = this;
		if (view === null) return { from: 0, to: 0 };
		return { from: view.earlier > 0 ? (moments[0]?.at ?? 0) : 0, to: view.later > 0 ? (moments.at(-1)?.at ?? view.until) : view.until };
	});
	/** What What-if begins from; null as long as that is not known. */
	readonly beginning = $derived(this.view !== null && this.view.obstacle === null ? { id: this.view.id, at: this.at } : null);

	/** Sends a recording, and reads it. */
	async bring(file: File): Promise<void> {
		const before = this.view?.id ?? null;
		this.#reset();
		this.coming = file.name;
		const asking = this.#begin();
		const name = new URLSearchParams({ name: file.name.slice(0, 255) });
		const signal = AbortSignal.any([asking.signal, AbortSignal.timeout(SENT)]);
		const answer = await request<Recording>('POST', `${ADDRESS}?${name}`, { file, signal });
		if (asking.signal.aborted) return;
		this.coming = null;
		if (before !== null) void request('DELETE', `${ADDRESS}/${before}`);
		this.#take(answer, true);
	}

	/** Reads it again, with the draft as it is now. */
	async readAgain(): Promise<void> {
		await this.#show(null, false);
	}

	/** Shows the moments after those that are here, or the first again. */
	async later(): Promise<void> {
		await this.#show(this.moments.at(-1)?.at ?? null, true);
	}

	async fromStart(): Promise<void> {
		await this.#show(null, true);
	}

	/** Looks at a time of the recording. */
	look(at: number): void {
		if (this.view === null) return;
		this.at = Math.max(0, Math.min(this.view.until, at));
		if (this.#timer !== null) clearTimeout(this.#timer);
		this.#timer = setTimeout(() => void this.#readState(), SETTLED);
	}

	/** Looks at a moment, by its place. */
	lookAt(index: number): void {
		const moment = this.moments[Math.max(0, Math.min(this.moments.length - 1, index))];
		if (moment !== undefined) this.look(moment.at);
	}

	/** Nobody wants it any more. */
	putAway(): void {
		const id = this.view?.id;
		this.#reset();
		if (id !== undefined) void request('DELETE', `${ADDRESS}/${id}`);
	}

	/** Nobody looks any more. It is kept for a while all the same. */
	close(): void {
		this.#asking?.abort();
		if (this.#timer !== null) clearTimeout(this.#timer);
	}

	#reset(): void {
		this.close();
		this.#asked++;
		[this.view, this.state, this.refusal, this.coming] = [null, null, null, null];
		this.pending = false;
		this.at = 0;
	}

	#begin(): AbortController {
		this.#asking?.abort();
		return (this.#asking = new AbortController());
	}

	async #show(since: number | null, toFirst: boolean): Promise<void> {
		if (this.view === null) return;
		const asking = this.#begin();
		this.pending = true;
		const query = since === null ? '' : (`?${new URLSearchParams({ since: String(since) })}` as const);
		const signal = AbortSignal.any([asking.signal, AbortSignal.timeout(PATIENCE)]);
		const answer = await request<Recording>('GET', `${ADDRESS}/${this.view.id}${query}`, { signal });
		if (asking.signal.aborted) return;
		this.pending = false;
		this.#take(answer, toFirst);
	}

	#take(answer: Awaited<ReturnType<typeof request<Recording>>>, toFirst: boolean): void {
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		this.view = answer.value;
		if (answer.value.obstacle !== null) this.state = null;
		else this.look(toFirst ? (answer.value.moments[0]?.at ?? 0) : this.at);
	}

	async #readState(): Promise<void> {
		const { view, at } = this;
		if (view === null || view.obstacle !== null) return;
		const asked = ++this.#asked;
		const query = new URLSearchParams({ at: String(at) });
		const answer = await request<RecordedState>('GET', `${ADDRESS}/${view.id}/state?${query}`, { patience: PATIENCE });
		if (asked !== this.#asked) return;
		this.refusal = answer.ok ? null : answer.refusal;
		this.state = answer.ok ? answer.value : null;
	}
}
