/** A deployment that was sent, until the station runs the model. */
import type { Simulation } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { follow, type Phase } from './progress.ts';
import { deployRevision } from './send.ts';

/** Milliseconds between two looks at the station, and after which it takes longer than usual. */
const LOOK = 250;
const LATE = 60_000;

/** A revision, which the draft is after its change `number`. */
export interface Wanted {
	readonly revision: string;
	readonly number: number;
	readonly reason: string;
	readonly simulation: Simulation;
}

export class Deployment {
	phase = $state<Phase>('sent');
	late = $state(false);
	/** Why it was undone. */
	why = $state<string | null>(null);
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

	/** Sends it; `ended` is called once the station runs it, or the model before again. Why it was refused, or null. */
	async send({ revision, number, reason, simulation }: Wanted, ended: () => void): Promise<Refusal | null> {
		const refusal = await deployRevision(revision, number, reason, simulation);
		if (refusal === null) {
			this.phase = 'accepted';
			const began = performance.now();
			this.#timer = setInterval(() => {
				this.#look(revision);
				this.late = performance.now() - began > LATE;
				if (this.phase !== 'runs' && this.phase !== 'undone') return;
				this.end();
				ended();
			}, LOOK);
		}
		return refusal;
	}

	/** Looks no further. */
	end(): void {
		clearInterval(this.#timer);
	}

	#look(revision: string): void {
		const { live, view } = this.#station;
		const outcome = view?.deployment?.revision === revision ? view.deployment : null;
		const heard = { live, production: view?.production ?? null, tick: view?.tick ?? 0, state: outcome?.state ?? null };
		this.phase = follow(this.phase, heard, this.#before);
		if (this.phase === 'undone') this.why = outcome?.why ?? null;
	}
}
