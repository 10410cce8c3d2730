/**
 * One correction, from the choice of values to its end.
 *
 * First values are chosen, then the station says what would follow, on which revision of the state; only on that the
 * correction is made. What is chosen stays whatever happens; what was looked at does not hold once the state has moved.
 *
 * What it takes besides, control and restart mode, is taken by the same press, each as an act of its own. That moves the
 * state: what follows is looked at once more, and only if it is the same is the correction made.
 */
import {
	askForApproval,
	correctEstimates,
	enterRestart,
	previewCorrection,
	takeControl,
	undoCorrection
} from '#lib/command/send.ts';
import type { CorrectionPreview, LastCorrection, StationView, Value } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { changesSince, type Change } from './moved.ts';
import { needsRestart } from './needs.ts';

/** Milliseconds: so often it is looked whether an act has come back over the stream, and so long at most. */
const [LOOK, PATIENCE] = [50, 8000];

/** What the correction needs that this session does not have yet. */
export interface Needs {
	readonly control: boolean;
	readonly restart: boolean;
}

/** What a person has read of a preview: what the correction makes so, and not what a station at work does next. */
function read({ safe, violates, completed, contradictions_new }: CorrectionPreview): string {
	return JSON.stringify([safe, violates, completed, contradictions_new]);
}

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
	/** What follows became another between the last look and the press: it is to be read again. */
	altered = $state(false);
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
	/** It is made at once, and can be taken back. */
	get isNew(): boolean {
		return this.undoes === null && !this.dual;
	}
	/** The state is another than the one that was looked at. */
	readonly moved: boolean = $derived.by(
		() => this.preview !== null && (this.#overtaken || (this.#station.view?.revision ?? 0) > this.preview.revision)
	);
	/** What is another than when it was looked at. */
	readonly since: readonly Change[] = $derived.by(() =>
		this.moved && this.#looked ? changesSince(this.#looked.variables, this.#station.view?.variables ?? {}) : []
	);

	/** It leads out of the safe states: that is asked once more, and so is what somebody else has to approve. */
	readonly asksTwice: boolean = $derived.by(
		() => this.dual || (this.preview !== null && this.preview.safe_now && !this.preview.safe)
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

	/** Takes what `needs` names, and makes it as it was looked at. True when it was accepted. */
	async make(needs: Needs = { control: false, restart: false }): Promise<boolean> {
		const { preview } = this;
		if (this.sending || preview === null || (this.moved && !needs.control && !needs.restart)) return false;
		this.sending = true;
		this.altered = false;
		this.refusal = null;
		const done = (await this.#prepare(needs, preview)) && (await this.#send());
		this.sending = false;
		if (!done) this.asked = false;
		return done;
	}

	/** Takes what it needs, and looks again whether the same follows. */
	async #prepare(needs: Needs, seen: CorrectionPreview): Promise<boolean> {
		if (needs.control) this.refusal = await takeControl(null, '');
		if (this.refusal === null && needs.restart) {
			this.refusal = await enterRestart();
			if (this.refusal === null) await this.#until((view) => !needsRestart(view));
		}
		if (this.refusal !== null) return false;
		if (!needs.control && !needs.restart) return true;
		await this.look();
		if (this.preview === null) return false;
		this.altered = read(this.preview) !== read(seen);
		return !this.altered;
	}

	async #send(): Promise<boolean> {
		const { preview } = this;
		if (preview === null) return false;
		const reason = this.reason.trim();
		this.refusal = this.undoes
			? await undoCorrection(this.undoes.revision, reason)
			: this.dual
				? await askForApproval({ kind: 'correction', values: this.values }, preview.revision, reason)
				: await correctEstimates(this.values, preview.revision, reason);
		if (this.refusal?.kind === 'stale-revision') this.#overtaken = true;
		return this.refusal === null;
	}

	async #until(holds: (view: StationView) => boolean): Promise<void> {
		for (let waited = 0; waited < PATIENCE; waited += LOOK) {
			if (this.#station.view !== null && holds(this.#station.view)) return;
			await new Promise((resolve) => setTimeout(resolve, LOOK));
		}
	}

	#forget(): void {
		this.#looked = null;
		this.#overtaken = false;
		this.altered = false;
		this.asked = false;
		this.refusal = null;
	}
}
