/** This device as a watch: asks the server what it is, and takes up a code. */
import type { WatchSelf } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { after, wearingOf, type Wearing } from './wearing.ts';

/** Under which this browser keeps the name of the watch that it is, to say so when it is one no longer. */
const KEPT = 'watch';

export class Worn {
	#wearing = $state.raw<Wearing>({ kind: 'none', lost: null });
	readonly wearing: Wearing = $derived(this.#wearing);

	/** `self` is the watch that the server takes this browser for. */
	constructor(self: WatchSelf | null) {
		this.#wearing = wearingOf(self, keptName());
	}

	/** Takes up the offer of `code`; null: an operator can confirm it now. */
	async pair(code: string): Promise<Refusal | null> {
		const answer = await request<WatchSelf>('POST', '/api/v1/wearables/pairing', { body: { code } });
		if (!answer.ok) return answer.refusal;
		this.#take(after(this.#wearing, answer));
		return null;
	}

	/** Asks the server what this device is now. */
	async look(): Promise<void> {
		this.#take(after(this.#wearing, await request<WatchSelf>('GET', '/api/v1/wearables/self')));
	}

	#take(wearing: Wearing): void {
		this.#wearing = wearing;
		if (wearing.kind === 'active') keepName(wearing.self.name);
	}
}

function keptName(): string | null {
	try {
		return localStorage.getItem(KEPT);
	} catch {
		return null;
	}
}

function keepName(name: string): void {
	try {
		localStorage.setItem(KEPT, name);
	} catch {
		// Storage may be forbidden; then the watch does not say what it was once.
	}
}
