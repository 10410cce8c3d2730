/** Whether a person is at something of the page Restart that must not go away under their hands: it keeps its step open. */
import { getContext, setContext } from 'svelte';

const KEY = Symbol('staying');

export class Staying {
	#count = $state(0);

	/** Somebody is at something. */
	get held(): boolean {
		return this.#count > 0;
	}

	/** Keeps the step open until what is returned is called. */
	hold(): () => void {
		this.#count += 1;
		return () => (this.#count -= 1);
	}
}

/** For all that is within the page. */
export function provideStaying(): Staying {
	return setContext(KEY, new Staying());
}

/** Of the page around; one of its own where there is none. */
export function useStaying(): Staying {
	return getContext<Staying | undefined>(KEY) ?? new Staying();
}
