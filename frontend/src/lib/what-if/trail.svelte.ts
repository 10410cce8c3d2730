/**
 * A station led through the draft step by step: branches of steps, of which one is looked at, and the moment in it.
 *
 * The server keeps nothing of it: each question has the values of the beginning and all steps up to here.
 */
import type { Step, StepMoment, Steps, StepsBody, Value } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';

/** One way that things could go. */
export interface Branch {
	readonly id: number;
	/** The branch that it leaves, and after which moment; null for the first. */
	readonly from: { readonly id: number; readonly at: number } | null;
	readonly steps: readonly Step[];
	readonly told: Steps;
}

/** Milliseconds: the server prepares the model first. */
const PATIENCE = 90_000;
/** Milliseconds for which one moment is shown while it is played. */
const SHOWN = 700;

export class Trail {
	branches = $state.raw<readonly Branch[]>([]);
	/** The moment that is looked at, by its place in the branch. */
	at = $state(0);
	pending = $state.raw<AbortController | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** The last step was none that can be taken, and why. */
	refused = $state.raw<Steps['refused']>(null);
	/** Why plans were followed no further the last time. */
	stopped = $state.raw<Steps['stopped']>(null);
	plays = $state(false);
	#current = $state(0);
	#next = 1;
	#clock: ReturnType<typeof setInterval> | null = null;

	/** The branch that is looked at. */
	get branch(): Branch | null {
		return this.branches.find(({ id }) => id === this.#current) ?? null;
	}

	get told(): Steps | null {
		return this.branch?.told ?? null;
	}

	get moments(): readonly StepMoment[] {
		return this.told?.moments ?? [];
	}

	/** The last moment is looked at: what can happen next is known there. */
	get isAtEnd(): boolean {
		return this.at === this.moments.length - 1;
	}

	/** All values after the moment that is looked at, and what those were that its step has changed. */
	readonly values = $derived.by(() => this.#valuesAfter(this.at));
	readonly changed = $derived(Object.fromEntries((this.moments[this.at]?.changes ?? []).map(({ name, before }) => [name, before])));

	/** Begins anew: from a record of the history, from a moment of a recording, or without either from the station as it is now. */
	async begin(from: Pick<Partial<StepsBody>, 'number' | 'recording'> = {}): Promise<void> {
		const told = await this.#ask(from);
		if (told === null) return;
		this.branches = [];
		this.#show({ id: this.#next++, from: null, steps: [], told }, 0);
	}

	/** Takes a step after the moment that is looked at; in a branch of its own where that has gone on otherwise. */
	async take(step: Step): Promise<void> {
		await this.#goOn({ steps: [...this.#steps(), step] });
	}

	/** Goes on from the moment that is looked at in a branch of its own: what can happen next there becomes known. */
	async branchOff(): Promise<void> {
		await this.#goOn({ steps: [...this.#steps()] });
	}

	/** Follows the plan from here to its end, or plans one after the other until a condition holds. */
	async follow(until: string | null): Promise<void> {
		await this.#goOn({ steps: [...this.#steps()], follow: true, ...(until === null ? {} : { until }) });
	}

	choose(id: number): void {
		this.stop();
		this.#current = id;
		this.at = this.moments.length - 1;
	}

	/** Puts a branch away. The first stays. */
	drop(id: number): void {
		this.branches = this.branches.filter((branch) => branch.id !== id);
		if (this.#current === id) this.choose(this.branches.at(-1)?.id ?? 0);
	}

	look(at: number): void {
		this.at = Math.max(0, Math.min(this.moments.length - 1, at));
	}

	/** Shows one moment after the other, from the first where the last was looked at. */
	play(): void {
		if (this.isAtEnd) this.at = 0;
		this.plays = true;
		this.#clock = setInterval(() => {
			this.look(this.at + 1);
			if (this.isAtEnd) this.stop();
		}, SHOWN);
	}

	stop(): void {
		this.plays = false;
		if (this.#clock !== null) clearInterval(this.#clock);
		this.#clock = null;
	}

	/** Nobody looks any more. */
	close(): void {
		this.stop();
		this.pending?.abort();
	}

	#steps(): readonly Step[] {
		return this.moments.slice(1, this.at + 1).map(({ step }) => step);
	}

	#valuesAfter(at: number): Record<string, Value | null> {
		const values: Record<string, Value | null> = { ...this.told?.before };
		for (const moment of this.moments.slice(0, Math.max(0, at + 1))) for (const { name, after } of moment.changes) values[name] = after;
		return values;
	}

	async #goOn(body: Partial<StepsBody>): Promise<void> {
		const { branch, at, isAtEnd } = this;
		if (branch === null) return;
		this.stop();
		const told = await this.#ask({ ...body, present: { ...branch.told.before } });
		if (told === null) return;
		this.refused = told.refused;
		this.stopped = told.stopped;
		if (told.refused !== null || told.obstacle !== null) return;
		const steps = told.moments.slice(1).map(({ step }) => step);
		const next: Branch = isAtEnd ? { ...branch, steps, told } : { id: this.#next++, from: { id: branch.id, at }, steps, told };
		this.#show(next, told.moments.length - 1);
	}

	#show(branch: Branch, at: number): void {
		const others = this.branches.filter(({ id }) => id !== branch.id);
		this.branches = [...others, branch].sort((one, other) => one.id - other.id);
		this.#current = branch.id;
		this.at = at;
	}

	async #ask(asked: Partial<StepsBody>): Promise<Steps | null> {
		this.pending?.abort();
		const asking = new AbortController();
		this.pending = asking;
		const body: StepsBody = { steps: [], follow: false, ...asked };
		const signal = AbortSignal.any([asking.signal, AbortSignal.timeout(PATIENCE)]);
		const answer = await request<Steps>('POST', '/api/v1/model/what-if/steps', { body, signal });
		if (this.pending !== asking) return null;
		this.pending = null;
		this.refused = this.stopped = null;
		this.refusal = answer.ok || asking.signal.aborted ? null : answer.refusal;
		return answer.ok ? answer.value : null;
	}
}
