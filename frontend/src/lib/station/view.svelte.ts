/** What the parts of the graph of Model share: the model as a whole, what is chosen in it, and what is tied to that. */
import { createContext } from 'svelte';
import type { Finding, ModelGraph } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { addressOf, type Looked } from './address.ts';
import { bandsOf } from './bands.ts';
import { findingsAt } from './findings.ts';
import { tiedTo, wholeOf, type Tied } from './graph.ts';
import { looseEnds } from './loose.ts';

/** Milliseconds in which a large model is looked through by a busy machine. */
const PATIENCE = 60_000;

export class StationView {
	#graph = $state.raw<ModelGraph | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	#asked = 0;
	/** Whether the focus goes to what is said of the thing that was chosen. */
	leads = false;
	readonly #looked: () => Looked;
	readonly #findings: () => readonly Finding[];
	readonly #go: (address: string) => void;

	readonly whole = $derived.by(() => this.#graph && wholeOf(this.#graph));
	readonly unread = $derived.by(() => this.#graph?.unread.length ?? 0);
	readonly loose = $derived.by(() => (this.whole ? looseEnds(this.whole) : new Map<number, never>()));
	readonly findings = $derived.by(() =>
		this.whole ? findingsAt(this.whole, this.#findings()) : new Map<number, Finding[]>()
	);
	readonly bands = $derived.by(() => {
		const { resource, kind } = this.#looked();
		return this.whole ? bandsOf(this.whole, { resource, kind }) : [];
	});
	readonly thing = $derived.by(() => this.whole?.byId.get(this.#looked().thing ?? '') ?? null);
	readonly tied = $derived.by((): Tied | null =>
		this.whole && this.thing ? tiedTo(this.whole, this.thing.index, this.#looked().steps) : null
	);

	constructor(looked: () => Looked, findings: () => readonly Finding[], go: (address: string) => void) {
		this.#looked = looked;
		this.#findings = findings;
		this.#go = go;
	}

	get looked(): Looked {
		return this.#looked();
	}

	/** Asks for the draft as it is now. Of several answers that are on their way only the newest counts. */
	async read(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<ModelGraph>('GET', askedOf('/api/v1/model/graph', this.looked.example), { patience: PATIENCE });
		if (asked !== this.#asked) return;
		if (answer.ok) this.#graph = answer.value;
		this.refusal = answer.ok ? null : answer.refusal;
	}

	/** Looks at something else. */
	look(change: Partial<Looked>): void {
		this.#go(addressOf({ ...this.looked, ...change }));
	}

	/** `leads` says that who chooses is led to what is said of it. */
	choose(id: string | null, leads = false): void {
		this.leads = leads;
		if (id !== this.looked.thing) this.look({ thing: id });
	}

	/** Whether a piece is above what is chosen, or below it, and how many steps away; null where it is not tied to it. */
	tie(index: number): { readonly way: 'up' | 'down' | 'both'; readonly steps: number } | null {
		const up = this.tied?.up.get(index)?.steps;
		const down = this.tied?.down.get(index)?.steps;
		if (up === undefined && down === undefined) return null;
		const way = up !== undefined && down !== undefined && up === down ? 'both' : (up ?? Infinity) < (down ?? Infinity) ? 'up' : 'down';
		return { way, steps: Math.min(up ?? Infinity, down ?? Infinity) };
	}
}

const [useStationView, setStationView] = createContext<StationView>();
export { setStationView, useStationView };
