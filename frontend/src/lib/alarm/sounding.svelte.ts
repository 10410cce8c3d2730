/**
 * The tone that a person may want for new alarms, in this browser. It is made here, so that no file has to come first.
 *
 * A browser lets a page sound only after a person has pressed something on it.
 */
const KEY = 'alarm-tone';
const ON = 'on';
/** Two notes, in hertz, each for so many seconds: told from the sounds of a device. */
const NOTES = [880, 660];
const LONG = 0.18;
const LOUD = 0.25;

function kept(): boolean {
	try {
		return localStorage.getItem(KEY) === ON;
	} catch {
		return false;
	}
}

class Sounding {
	/** Whether the tone is wanted. */
	wanted = $state(kept());
	/** Whether the browser lets this page sound. */
	allowed = $state(false);
	/** Whether the browser can sound at all. */
	readonly possible = typeof AudioContext === 'function';
	#context: AudioContext | null = null;

	/** Wants the tone or not, from now on, and keeps that. */
	want(wanted: boolean): void {
		this.wanted = wanted;
		try {
			if (wanted) localStorage.setItem(KEY, ON);
			else localStorage.removeItem(KEY);
		} catch {
			// It lasts as long as the page then.
		}
		if (wanted) void this.wake();
	}

	/** Asks the browser to let the page sound; only what a person has pressed can make it so. */
	async wake(): Promise<void> {
		if (!this.possible) return;
		this.#context ??= new AudioContext();
		const context = this.#context;
		// What a browser does not allow yet, it answers once it does.
		context.onstatechange = () => (this.allowed = context.state === 'running');
		await context.resume().catch(() => undefined);
		this.allowed = context.state === 'running';
	}

	/** Sounds once, if the browser lets it. */
	sound(): void {
		const context = this.#context;
		if (context?.state !== 'running') return;
		NOTES.forEach((hertz, place) => {
			const from = context.currentTime + place * LONG;
			const note = new OscillatorNode(context, { type: 'triangle', frequency: hertz });
			const volume = new GainNode(context, { gain: 0 });
			// It swells and fades, or it would click.
			volume.gain.setValueAtTime(0, from);
			volume.gain.linearRampToValueAtTime(LOUD, from + 0.02);
			volume.gain.linearRampToValueAtTime(0, from + LONG);
			note.connect(volume).connect(context.destination);
			note.start(from);
			note.stop(from + LONG);
		});
	}
}

/** The one of this page. */
export const sounding = new Sounding();
