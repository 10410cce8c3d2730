/** The tones with which the watch tells of a task, and of what is wrong. They can be turned off, which is kept in this browser. */

const KEY = 'watch-sound';
const OFF = 'off';
/** Hertz, one after the other: a rising pair is heard beside machines. */
const TONES = [880, 1320];
/** The same for what is wrong: a falling pair, twice. */
const CALL = [1320, 880, 1320, 880];
/** Seconds that each lasts. */
const LENGTH = 0.14;
const LOUDNESS = 0.4;

export class Sound {
	#on = $state(keptOn());
	#audio: AudioContext | null = null;

	/** Whether it is heard. */
	get on(): boolean {
		return this.#on;
	}

	turn(on: boolean): void {
		this.#on = on;
		try {
			if (on) localStorage.removeItem(KEY);
			else localStorage.setItem(KEY, OFF);
		} catch {
			// It lasts as long as the page then.
		}
		if (on) this.play();
	}

	/** Browsers let a page be heard only once it was touched: every touch readies it. The result ends that. */
	attach(): () => void {
		const ready = (): void => {
			if (!('AudioContext' in window)) return;
			this.#audio ??= new AudioContext();
			if (this.#audio.state === 'suspended') void this.#audio.resume().catch(() => undefined);
		};
		document.addEventListener('pointerup', ready);
		document.addEventListener('keydown', ready);
		return () => {
			document.removeEventListener('pointerup', ready);
			document.removeEventListener('keydown', ready);
			void this.#audio?.close();
			this.#audio = null;
		};
	}

	/** Sounds once, where it is on and the page was touched: for a task, or a `call` for what is wrong. */
	play(call = false): void {
		const audio = this.#audio;
		if (!this.#on || audio === null || audio.state === 'closed') return;
		(call ? CALL : TONES).forEach((hertz, n) => {
			const [tone, volume] = [audio.createOscillator(), audio.createGain()];
			const start = audio.currentTime + n * LENGTH;
			tone.frequency.value = hertz;
			volume.gain.setValueAtTime(LOUDNESS, start);
			// A tone that ends at once clicks.
			volume.gain.exponentialRampToValueAtTime(0.001, start + LENGTH);
			tone.connect(volume).connect(audio.destination);
			tone.start(start);
			tone.stop(start + LENGTH);
		});
	}
}

function keptOn(): boolean {
	try {
		return localStorage.getItem(KEY) !== OFF;
	} catch {
		return true;
	}
}
