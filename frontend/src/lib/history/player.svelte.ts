/** Lets the past run on from the chosen moment, as fast as is wanted, until it meets the present. */
import type { History } from './history.svelte.ts';

export const SPEEDS = [1, 4, 16] as const;
/** Milliseconds between two looks. */
const EVERY = 300;
/** Seconds that pass at most between two looks: where the station is slow to tell, the past waits for it. */
const MOST = 1;
/** Milliseconds between two looks whether it is told how the station was then. */
const SOON = 50;

export class Player {
	/** The moment that it has come to; null while it stands. */
	time = $state<number | null>(null);
	speed = $state<number>(SPEEDS[1]);
	readonly #history: History;
	#run = 0;

	constructor(history: History) {
		this.#history = history;
	}

	/** Runs on from the chosen moment, or from the beginning of what is in sight; when it runs, stops. */
	toggle(): void {
		if (this.time === null) void this.#play();
		else this.stop();
	}

	stop(): void {
		this.#run += 1;
		this.time = null;
	}

	/** Waits until it is told how the station was at the chosen moment, so that nothing runs ahead of what is shown. */
	async #shown(run: number): Promise<void> {
		const history = this.#history;
		const waits = (): boolean => history.momentRefusal === null && history.moment?.record.number !== history.place?.number;
		while (run === this.#run && waits()) await new Promise((after) => setTimeout(after, SOON));
	}

	async #play(): Promise<void> {
		const history = this.#history;
		const run = ++this.#run;
		const end = history.line?.last.time;
		if (end === undefined) return;
		const from = history.place?.time ?? history.window.from;
		let time = from >= end ? history.window.from : from;
		this.time = time;
		await history.chooseAt(time);
		let shown = history.place?.number;
		await this.#shown(run);
		for (let last = performance.now(); run === this.#run; ) {
			await new Promise((after) => setTimeout(after, EVERY));
			if (run !== this.#run) return;
			// Somebody has chosen another moment meanwhile, or gone back to now.
			if (history.place?.number !== shown) return this.stop();
			const now = performance.now();
			time += Math.min((now - last) / 1000, MOST) * this.speed;
			last = now;
			const next = Math.min(time, end);
			await history.chooseAt(next);
			shown = history.place?.number;
			await this.#shown(run);
			if (run !== this.#run) return;
			this.time = next;
			if (time >= end) this.stop();
		}
	}
}
