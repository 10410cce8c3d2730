/**
 * The station as this page knows it: the last document, and whether it is still true.
 *
 * One `Station` serves all pages; components take it with `useStation()` and derive what they show from it.
 */
import { createContext } from 'svelte';
import type { StationView } from '#lib/contract.ts';
import { connect, type Connection } from './connection.ts';
import { SILENCE, clockDifference, hear, serverAge, type Hearing } from './hearing.ts';
import { judge, type Liveness } from './liveness.ts';
import { NOTHING, receive, type Stream } from './receive.ts';
import { Recorder } from './recorder.ts';
import { titled } from '#lib/wording/titled.svelte.ts';

/** Milliseconds between two looks at the clock. */
const REFRESH = 150;
/** Milliseconds after which a snapshot that was asked for and did not come is asked for again. */
const ASK_AGAIN = 2000;

export class Station {
	#stream = $state.raw<Stream>(NOTHING);
	#hearing = $state.raw<Hearing>(SILENCE);
	#open = $state(false);
	#now = $state(0);
	#names = $state.raw<readonly string[]>([]);
	#connection: Connection | null = null;

	/** What the variables were during the last minute. It is no state: who shows it looks again from time to time. */
	readonly recorder = new Recorder();
	/** The names of all variables. They are others only when the station is another. */
	get names(): readonly string[] {
		return this.#names;
	}

	/** The last document, live or not, with titles in the language of the page; null before the first. */
	readonly view: StationView | null = $derived(titled(this.#stream.view));
	readonly liveness: Liveness = $derived(judge(this.#stream, this.#hearing, this.#open, this.#now));
	readonly live: boolean = $derived(this.liveness.live);
	/** What the server last complained of. */
	readonly trouble: string | null = $derived(this.#stream.trouble);
	/** Seconds on the controller's clock. It stands still while the view is old, so that no duration goes on growing. */
	readonly time: number = $derived.by(() => {
		const difference = clockDifference(this.#hearing);
		if (this.live && difference !== null) return (this.#now - difference) / 1000;
		return this.view?.time ?? 0;
	});

	/** Connects to the server's stream; the result disconnects. `closed` is told each time the connection is lost. */
	attach(closed: (code: number) => void): () => void {
		const look = (): void => {
			this.#now = performance.now();
		};
		let asked = -Infinity;
		let attached = true;
		const connection = connect('/api/v1/stream', {
			opened: () => {
				this.#open = true;
			},
			heard: (message) => {
				const before = this.#stream;
				this.#stream = receive(before, message);
				if (this.#stream.view !== before.view && this.recorder.hear(message))
					this.#names = Object.keys(this.#stream.view?.variables ?? {});
				look();
				if (this.#stream.gap && this.#now - asked > ASK_AGAIN) {
					asked = this.#now;
					connection.resync();
				}
				const time = this.#stream.view?.time;
				const age = message.kind === 'snapshot' ? serverAge(message) : null;
				// Only the controller's own clock proves that the controller is behind a message.
				if (time !== undefined && (time !== before.view?.time || message.kind === 'snapshot'))
					this.#hearing = hear(this.#hearing, this.#now, time * 1000, age);
			},
			closed: (code) => {
				this.#open = false;
				look();
				if (attached) closed(code);
			}
		});
		this.#connection = connection;
		const timer = setInterval(look, REFRESH);
		// A page that comes to the front must not show for a moment what was true when it left.
		document.addEventListener('visibilitychange', look);
		return () => {
			attached = false;
			clearInterval(timer);
			document.removeEventListener('visibilitychange', look);
			connection.close();
			this.#connection = null;
		};
	}

	/** Connects to the server anew at once. */
	tryNow(): void {
		this.#connection?.again();
	}
}

const [useStation, setStation] = createContext<Station>();
export { useStation };

/** Makes a station for all components below. */
export function provideStation(): Station {
	return setStation(new Station());
}
