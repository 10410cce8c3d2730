/** A deployment that was sent, until the station runs the model. */
import type { Refusal } from '#lib/rest/refusal.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { follow, type Phase } from './progress.ts';
import { deployRevision } from './send.ts';

/** Milliseconds between two looks at the station, and after which it takes longer than usual. */
const LOOK = 250;
const LATE = 60_000;

export class Deployment {
	phase = $state<Phase>('sent');
	late = $state(false);
	readonly name: string;
	readonly #station: Station;
	readonly #before: number;
	#timer: ReturnType<typeof setInterval> | undefined;

	/** Of the revision that is called `name`, upon what `station` shows now. */
	constructor(name: string, station: Station) {
		this.name = name;
		this.#station = station;
		this.#before = station.view?.tick ?? 0;
	}

	/** Sends it; `ran` is called once the station runs it. Why it was refused, or null. */
	async send(revision: string, number: number, reason: string, ran: () => void): Promise<Refusal | null> {
		const refusal = await deployRevision(revision, number, reason);
		if (refusal === null) {
			this.phase = 'accepted';
			const began = performance.now();
			this.#timer = setInterval(() => {
				this.#look();
				this.late = performance.now() - began > LATE;
				if (this.phase !== 'runs') return;
				this.end();
				ran();
			}, LOOK);
		}
		return refusal;
	}

	/** Looks no further. */
	end(): void {
		clearInterval(this.#timer);
	}

	#look(): void {
		const { live, view } = this.#station;
		const heard = { live, production: view?.production ?? null, tick: view?.tick ?? 0 };
		this.phase = follow(this.phase, heard, this.#before);
	}
}
