/** The scenarios by which the draft is tested, as the server finds them and as they ran last. */
import type { Scenarios } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';

const ADDRESS = '/api/v1/model/scenarios';
/** Milliseconds: the server prepares the model first, and then carries them out. */
const PATIENCE = { list: 60_000, run: 220_000 };

export class ScenarioList {
	/** Those that there are; null before they were asked for. */
	listed = $state.raw<Scenarios | null>(null);
	/** How they ran, and the change of the draft after which they did. */
	ran = $state.raw<Scenarios | null>(null);
	/** What is carried out now: all of them, or one by its name. */
	running = $state<string | true | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	#asking: AbortController | null = null;

	/** Asks for them, as the draft is another one. */
	async list(): Promise<void> {
		const answer = await request<Scenarios>('GET', ADDRESS, { patience: PATIENCE.list });
		if (answer.ok) this.listed = answer.value;
		else this.refusal = answer.refusal;
	}

	/** Carries all of them out, or one; how the others ran before stays. */
	async run(name: string | null = null): Promise<void> {
		if (this.running !== null) return;
		this.running = name ?? true;
		this.#asking = new AbortController();
		const signal = AbortSignal.any([this.#asking.signal, AbortSignal.timeout(PATIENCE.run)]);
		const answer = await request<Scenarios>('POST', `${ADDRESS}/run`, { body: { names: name === null ? [] : [name] }, signal });
		this.running = null;
		this.refusal = answer.ok || this.#asking.signal.aborted ? null : answer.refusal;
		if (!answer.ok) return;
		this.listed = answer.value;
		const { runs, number } = answer.value;
		const before = this.ran?.number === number ? this.ran : null;
		const others = name === null ? [] : (before?.runs ?? []).filter((each) => each.name !== name);
		const unused = name === null ? answer.value.not_exercised : (before?.not_exercised ?? {});
		this.ran = { ...answer.value, runs: [...others, ...runs], not_exercised: unused };
	}

	/** Nobody looks any more: what is carried out is ended. */
	close(): void {
		this.#asking?.abort();
	}
}
