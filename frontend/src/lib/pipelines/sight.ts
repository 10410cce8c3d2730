/** From how far the graph is looked at. */
import { createContext } from 'svelte';

export interface Sight {
	/** Nothing on it can be read. */
	readonly far: boolean;
}

const [useSight, setSight] = createContext<Sight>();
export { setSight, useSight };
