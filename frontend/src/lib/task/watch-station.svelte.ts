/** The station as a watch is shown it: the tasks of its own resource, and whether they are still as they were told. */
import type { WatchSnapshot, WatchStreamMessage } from '#lib/contract.ts';
import { connect } from '#lib/stream/connection.ts';
import { SILENCE, hear, serverAge, type Hearing } from '#lib/stream/hearing.ts';
import { judge, type Liveness } from '#lib/stream/liveness.ts';
import { titled } from '#lib/wording/titled.svelte.ts';

/** Milliseconds between two looks at the clock. */
const REFRESH = 150;

export class WatchStation {
	#snapshot = $state.raw<WatchSnapshot | null>(null);
	#controller = $state<'heard' | 'lost'>('heard');
	#hearing = $state.raw<Hearing>(SILENCE);
	#open = $state(false);
	#now = $state(0);

	/** What was last told, live or not; null before the first. */
	readonly snapshot: WatchSnapshot | null = $derived(titled(this.#snapshot));
	readonly liveness: Liveness = $derived(
		judge({ view: this.#snapshot, controller: this.#controller, gap: false }, this.#hearing, this.#open, this.#now)
	);

	/** Connects to the stream; the result disconnects. `closed` is called each time the connection is lost. */
	attach(closed: () => void): () => void {
		const look = (): void => {
			this.#now = performance.now();
		};
		let attached = true;
		const connection = connect<WatchStreamMessage>('/api/v1/wearables/stream', {
			opened: () => {
				this.#open = true;
			},
			heard: (message) => {
				look();
				this.#take(message);
			},
			closed: () => {
				this.#open = false;
				look();
				if (attached) closed();
			}
		});
		const timer = setInterval(look, REFRESH);
		document.addEventListener('visibilitychange', look);
		return () => {
			attached = false;
			clearInterval(timer);
			document.removeEventListener('visibilitychange', look);
			connection.close();
		};
	}

	#take(message: WatchStreamMessage): void {
		switch (message.kind) {
			case 'watch':
				this.#controller = 'heard';
				this.#snapshot = message;
				this.#hearing = hear(this.#hearing, this.#now, message.time * 1000, serverAge(message));
				break;
			case 'link':
				this.#controller = message.controller === 'heard' ? 'heard' : 'lost';
				break;
			case 'error':
				break;
		}
	}
}
