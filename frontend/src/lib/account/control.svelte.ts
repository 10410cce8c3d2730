/** Control as this session sees it: who holds it, and whether this session may act on what moves. */
import type { Control } from '#lib/contract.ts';
import { useStation, type Station } from '#lib/stream/station.svelte.ts';
import { holderOf, type Holder } from './holder.ts';
import { useSession, type Session } from './session.svelte.ts';

export class ControlSeen {
	readonly #station: Station;
	readonly #session: Session;

	/** Who holds it; null for nobody. */
	readonly holds: Control | null = $derived.by(() => this.#station.view?.control ?? null);
	readonly holder: Holder = $derived.by(() =>
		holderOf(this.holds, this.#session.id, this.#session.kind === 'person' ? (this.#session.person?.id ?? null) : null)
	);
	readonly mine: boolean = $derived(this.holder === 'you');
	/** Something is wanted that needs it, and nobody has it: the station does not work by itself, or waits for the start of production. */
	readonly wanted: boolean = $derived.by(() => {
		const view = this.#station.view;
		if (view === null || view.production === 'preparing') return false; // nothing is taken yet, control neither
		return view.control === null && (view.mode !== 'automatic' || view.production === 'waiting');
	});

	constructor(station: Station, session: Session) {
		this.#station = station;
		this.#session = session;
	}
}

/** Control as seen by the component that asks. */
export function seeControl(): ControlSeen {
	return new ControlSeen(useStation(), useSession());
}
