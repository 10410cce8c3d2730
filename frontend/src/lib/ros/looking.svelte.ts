/**
 * The network as this page looks at it: calmly, once a second, so that figures can be read. What the station counts comes
 * from its stream; who is on the network is asked of the server.
 */
import type { Network, Topic } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { noted, rateOf, type Note } from './traffic.ts';

/** Seconds after which what was read of the network is old: it is read every two seconds. */
const OLD_AFTER = 6;

export class Looking {
	/** What was read last; null before the first answer. */
	network = $state.raw<Network | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** The topics of the station as they were at `time` (seconds, on the controller's clock). */
	topics = $state.raw<Readonly<Record<string, Topic>>>({});
	time = $state(0);
	/** Seconds since the network was read; null before that. */
	age = $state<number | null>(null);
	#live = $state(false);
	#notes = $state.raw<readonly Note[]>([]);
	#readAt: number | null = null;
	#asking = false;

	/** Whether what is shown may be taken for the network as it is now. */
	readonly live: boolean = $derived(this.#live && this.age !== null && this.age < OLD_AFTER);

	/** Takes note of what the stream says now. */
	step(station: Station): void {
		this.#live = station.live;
		if (station.live && station.view !== null) {
			this.topics = station.view.topics;
			this.time = station.view.time;
			this.#notes = noted(this.#notes, this.time, this.topics);
		}
		this.#look();
	}

	/** Asks who is on the network. */
	async read(): Promise<void> {
		if (this.#asking) return;
		this.#asking = true;
		const answer = await request<Network>('GET', '/api/v1/ros/graph');
		this.#asking = false;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		this.network = answer.value;
		this.#readAt = performance.now();
		this.#look();
	}

	/** Messages per second of a topic of the station over the last seconds; null while that is not known. */
	rate(name: string): number | null {
		return this.live ? rateOf(this.#notes, name) : null;
	}

	#look(): void {
		this.age = this.#readAt === null ? null : (performance.now() - this.#readAt) / 1000;
	}
}
