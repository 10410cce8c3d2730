/**
 * One correction, from the choice of values to its end.
 *
 * First values are chosen, then the station says what would follow, on which revision of the state; only on that the
 * correction is made. What is chosen stays whatever happens; what was looked at does not hold once the state has moved.
 */
import { askForApproval, correctEstimates, previewCorrection, undoCorrection } from '#lib/command/send.ts';
import type { CorrectionPreview, LastCorrection, StationView, Value } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { changesSince, type Change } from './moved.ts';

export class Correction {
	readonly #station: Station;
	/** The correction that is taken back; null where it is a new one. */
	readonly undoes: LastCorrection | null;
	readonly names: readonly string[];
	#chosen = $state.raw<Readonly<Record<string, Value>>>({});
	/** What was looked at, and the variables as they were then. */
	#looked = $state.raw<{ preview: CorrectionPreview; variables: StationView['variables'] } | null>(null);
	/** The server said that what was looked at does not hold any more. */
	#overtaken = $state(false);

	reason = $state('');
	/** What follows is being worked out. */
	looking = $state(false);
	/** It is on its way. */
	sending = $state(false);
	/** Whether it shall be made is asked once more. */
	asked = $state(false);
	refusal = $state.raw<Refusal | null>(null);

	readonly preview: CorrectionPreview | null = $derived(this.#looked?.preview ?? null);
	/** The values that it would change, by their names. */
	readonly values: Readonly<Record<string, Value>> = $derived.by(() => {
		const variables = this.#station.view?.variables ?? {};
		const differs = ([name, value]: [string, Value]): boolean => variables[name]?.value !== value;
		return Object.fromEntries(Object.entries(this.#chosen).filter(differs));
	});
	readonly changes: boolean = $derived(Object.keys(this.values).length > 0);
	/** A second person has to approve it. */
	readonly dual: boolean = $derived.by(() => {
		const variables = this.#station.view?.variables ?? {};
		return this.undoes === null && Object.keys(this.values).some((name) => variables[name]?.dual_approval === true);
	});
	/** The state is another than the one that was looked at. */
	readonly moved: boolean = $derived.by(
		() => this.preview !== null && (this.#overtaken || (this.#station.view?.revision ?? 0) > this.preview.revision)
	);
	/** What is another than when it was looked at. */
	readonly since: readonly Change[] = $derived.by(() =>
		this.moved && this.#looked ? changesSince(this.#looked.variables, this.#station.view?.variables ?? {}) : []
	);

	constructor(station: Station, names: readonly string[], undoes: LastCorrection | null = null) {
		this.#station = station;
		this.names = names;
		this.undoes = undoes;
		if (undoes) this.#chosen = undoes.before;
	}

	/** What a variable is to be; undefined where it is left as it is. */
	chosen(name: string): Value | undefined {
		return this.#chosen[name];
	}

	/** Chooses another value. What was looked at was about others. */
	choose(name: string, value: Value | undefined): void {
		const { [name]: _, ...others } = this.#chosen;
		this.#chosen = value === undefined ? others : { ...others, [name]: value };
		this.#forget();
	}

	/** Asks what would follow. Nothing is changed by it. */
	async look(): Promise<void> {
		if (this.looking || !this.changes) return;
		const values = this.values;
		this.looking = true;
		this.refusal = null;
		const answer = await previewCorrection(values);
		this.looking = false;
		if (!answer.ok) {
			this.#forget();
			this.refusal = answer.refusal;
			return;
		}
		// Something else may have been chosen while the answer was on its way.
		if (JSON.stringify(values) !== JSON.stringify(this.values)) return;
		this.#overtaken = false;
		this.#looked = { preview: answer.value, variables: this.#station.view?.variables ?? {} };
	}

	/** Makes it as it was looked at. True when it was accepted. */
	async make(): Promise<boolean> {
		const { preview } = this;
		if (this.sending || preview === null || this.moved) return false;
		const reason = this.reason.trim();
		this.sending = true;
		this.refusal = this.undoes
			? await undoCorrection(this.undoes.revision, reason)
			: this.dual
				? await askForApproval({ kind: 'correction', values: this.values }, preview.revision, reason)
				: await correctEstimates(this.values, preview.revision, reason);
		this.sending = false;
		if (this.refusal === null) return true;
		this.asked = false;
		if (this.refusal.kind === 'stale-revision') this.#overtaken = true;
		return false;
	}

	#forget(): void {
		this.#looked = null;
		this.#overtaken = false;
		this.asked = false;
		this.refusal = null;
	}
}
