/**
 * The states that the draft can come to, folded by chosen variables: what is asked for, what is told, and which node is
 * looked at. The server keeps what it has reached of a draft, so another choice is soon answered.
 */
import type { FoldedState, StateArrow, StateSpaceBody, StateSpaceQuestion, StateSpaceTold } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { told } from '#lib/text/message.ts';
import { drawnArrows, onPath } from './drawn.ts';

/** Milliseconds: the server prepares the model first, and then finds what it can come to. */
const PATIENCE = 120_000;

export class StateSpace {
	view = $state.raw<StateSpaceTold | null>(null);
	pending = $state.raw<AbortController | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** What was asked last. */
	asked = $state.raw<StateSpaceQuestion>({ extent: 'edge', plan: true, cut: [] });
	/** The node that is looked at, by its place. */
	node = $state<number | null>(null);
	/** Whether arrows are drawn for several things at once. */
	together = $state(false);

	readonly arrows = $derived(this.view === null ? [] : drawnArrows(this.view, this.together));
	/** The pairs of nodes that the plan goes through. */
	readonly path = $derived(onPath(this.view?.path ?? []));

	constructor(cut: readonly string[]) {
		this.asked = { ...this.asked, cut: [...cut] };
	}

	get nodes(): readonly FoldedState[] {
		return this.view?.nodes ?? [];
	}

	/** The names of the variables that are chosen, in their order. */
	get chosen(): readonly string[] {
		return this.view?.chosen.map(({ name }) => name) ?? [];
	}

	/** Asks for something otherwise than before. */
	async ask(changed: Partial<StateSpaceQuestion> = {}): Promise<void> {
		this.pending?.abort();
		const asking = new AbortController();
		this.pending = asking;
		const question = { ...this.asked, ...changed };
		const body: StateSpaceBody = { question };
		const signal = AbortSignal.any([asking.signal, AbortSignal.timeout(PATIENCE)]);
		const answer = await request<StateSpaceTold>('POST', '/api/v1/model/what-if/state-space', { body, signal });
		if (this.pending !== asking) return;
		this.pending = null;
		this.refusal = answer.ok || asking.signal.aborted ? null : answer.refusal;
		if (!answer.ok) return;
		const names = answer.value.chosen.map(({ name }) => name);
		// What was chosen for somebody stays until they choose otherwise.
		this.asked = answer.value.obstacle === null ? { ...question, variables: names } : question;
		const kept = this.node === null ? null : this.#same(this.node, answer.value);
		this.view = answer.value;
		this.node = kept;
	}

	/** The server waits for nobody any more. */
	close(): void {
		this.pending?.abort();
	}

	/** What a value of the chosen variable at `place` is called. */
	valueOf(place: number, value: FoldedState['values'][number]): string {
		const said = this.view?.chosen[place]?.values.find((each) => each.value === value)?.title;
		return told(said, String(value));
	}

	/** A node in words: the values of the chosen variables. */
	called(node: number): string {
		const chosen = this.view?.chosen ?? [];
		return (this.nodes[node]?.values ?? []).map((value, place) => `${told(chosen[place]?.title, '')}: ${this.valueOf(place, value)}`).join(', ');
	}

	/** All that leads from a node, or to it, whether it is drawn or not. */
	leading(node: number, from: boolean): readonly StateArrow[] {
		return (this.view?.arrows ?? []).filter((arrow) => (from ? arrow.source : arrow.sink) === node);
	}

	/** The place of a node in another answer; null where it is not there. */
	#same(node: number, other: StateSpaceTold): number | null {
		const before = this.view;
		const values = JSON.stringify(before?.nodes[node]?.values);
		if (JSON.stringify(before?.chosen.map(({ name }) => name)) !== JSON.stringify(other.chosen.map(({ name }) => name))) return null;
		const found = other.nodes.findIndex((each) => JSON.stringify(each.values) === values);
		return found < 0 ? null : found;
	}
}
