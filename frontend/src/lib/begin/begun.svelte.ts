/** What was put into the draft step by step, told on the page Model, to which that leads. */
export interface Begun {
	/** What the change is called. */
	readonly title: string;
	/** Topics that could not be taken in, each with why. */
	readonly failed: readonly { readonly topic: string; readonly why: string }[];
	/** Whether it is the last change of the draft, which can be taken back at once. */
	readonly isLast: boolean;
}

class Arrival {
	now = $state.raw<Begun | null>(null);
}

export const arrival = new Arrival();
