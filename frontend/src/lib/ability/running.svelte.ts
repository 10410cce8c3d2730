/** An ability of the model in the station that runs: the one that is looked at of all that it stands for, and what of it holds now. */
import { createContext } from 'svelte';
import type { Ability, AbilityDefinition } from '#lib/contract.ts';
import { everyInFront } from '#lib/rest/reading.svelte.ts';
import { LiveReading } from '#lib/rest/live-reading.svelte.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { Durations, usualOf, type Usual } from './measured.svelte.ts';
import { isOf } from './names.ts';

/** Milliseconds between two questions where the station tells of no change: the supervisor's guards may be new. */
const READ = 3000;

/** Seconds for which it stays as it was how long abilities took. */
const AGAIN = 60;

export class Running {
	readonly #station: Station;
	readonly #of: () => string | null;
	readonly #asked: () => string | null;
	/** The one that somebody wants to see of several. */
	wanted = $state<string | null>(null);

	/** All that the ability stands for. */
	readonly all: readonly (readonly [name: string, ability: Ability])[] = $derived.by(() => {
		const of = this.#of();
		return of === null ? [] : Object.entries(this.#station.view?.abilities ?? {}).filter(([name]) => isOf(name, of));
	});
	/** The one that was asked for, else one that runs. */
	readonly #chosen = $derived.by(
		() =>
			[this.wanted, this.#asked()].flatMap((each) => this.all.filter(([name]) => name === each))[0] ??
			this.all.find(([, { running_since }]) => running_since !== null) ??
			this.all[0] ??
			null
	);
	readonly name: string | null = $derived.by(() => this.#chosen?.[0] ?? null);
	readonly live = $derived.by(() =>
		this.name === null ? null : new LiveReading<AbilityDefinition>(`/api/v1/abilities/${encodeURIComponent(this.name)}/definition`)
	);
	readonly #durations = new Durations();
	/** When it was looked back last, in seconds. */
	#measured = -Infinity;
	/** How long all that it stands for usually took; null where that is not known. */
	readonly usual: Usual | null = $derived.by(() => usualOf(this.all.flatMap(([name]) => this.#durations.of(name))));
	readonly #revision = $derived.by(() => this.#station.view?.revision);

	/** `of` is an ability of the model, and `asked` one of those that it stands for; null for none. */
	constructor(station: Station, of: () => string | null, asked: () => string | null) {
		this.#station = station;
		this.#of = of;
		this.#asked = asked;
	}

	get ability(): Ability | null {
		return this.#chosen?.[1] ?? null;
	}

	get definition(): AbilityDefinition | null {
		return this.live?.value ?? null;
	}

	/** Looks back on how long abilities took, unless that was only just done. */
	async measure(): Promise<void> {
		const now = this.#station.time;
		if (!this.#station.live || now - this.#measured < AGAIN) return;
		this.#measured = now;
		await this.#durations.read(now);
	}

	/** Asks with every change of the station, and from time to time; in an effect, which ends that. */
	follow(): (() => void) | undefined {
		const { live } = this;
		if (live === null || this.#revision === undefined) return;
		return everyInFront(READ, () => void live.look());
	}
}

const [useRunning, setRunning] = createContext<Running>();
export { setRunning, useRunning };
