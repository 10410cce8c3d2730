/** What became of Pause or Hold where the view does not show it: told once, and anew with each press. */

export interface Stopped {
	readonly wanted: 'paused' | 'hold';
	/** `noAnswer`: nobody knows whether it has arrived. */
	readonly outcome: 'arrived' | 'notSent' | 'noAnswer';
}

class Stopping {
	said = $state.raw<Stopped | null>(null);
	/** The notice that the view is old is in sight, and tells it. */
	inNotice = $state(false);
}

export const stopping = new Stopping();
