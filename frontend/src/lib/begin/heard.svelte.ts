/** The network as long as somebody looks at it. */
import { createContext } from 'svelte';
import type { Network } from '#lib/contract.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';
import { nodesOn, type FoundNode } from './network.ts';

/** Milliseconds between two questions who is on the network. */
const EVERY = 3000;

export class Heard {
	readonly #reading = new Reading<Network>('/api/v1/ros/graph');
	readonly nodes: readonly FoundNode[] = $derived(nodesOn(this.#reading.value));

	/** Whether it was read once. */
	get isRead(): boolean {
		return this.#reading.value !== null;
	}

	get refusal(): Reading<Network>['refusal'] {
		return this.#reading.refusal;
	}

	follow(): () => void {
		return this.#reading.every(EVERY);
	}
}

const [useHeard, setHeard] = createContext<Heard>();
export { setHeard, useHeard };
