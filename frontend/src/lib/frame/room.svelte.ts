/** How much room the frame has, measured in letters: on a narrow screen, and where text is enlarged, there is little. */

class Room {
	/** Pixels. */
	width = $state(0);
	/** Pixels of a rem. */
	rem = $state(16);
	/** There is none for the rail; in rem, so that enlarged text counts. */
	readonly small: boolean = $derived(this.width < 64 * this.rem);
	/** There is some for what must be in sight only. */
	readonly narrow: boolean = $derived(this.width < 35 * this.rem);

	constructor() {
		if (typeof window !== 'undefined') this.width = window.innerWidth;
	}
}

export const room = new Room();
