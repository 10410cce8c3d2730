/** How the watch gets through to the person who wears it, where the browser can. */

/** A short vibration. Browsers allow it only after the page was touched once. */
export function buzz(): void {
	if ('vibrate' in navigator && navigator.userActivation.hasBeenActive) navigator.vibrate([150, 80, 150]);
}

/** A key that is held down presses once. */
export function once(event: KeyboardEvent): void {
	if (event.repeat) event.preventDefault();
}

/** Keeps the screen on while the page is in front; the result gives it back. */
export function keepAwake(): () => void {
	let lock: WakeLockSentinel | null = null;
	let ended = false;

	async function ask(): Promise<void> {
		if (ended || document.visibilityState !== 'visible' || !('wakeLock' in navigator)) return;
		try {
			const given = await navigator.wakeLock.request('screen');
			// It may have been given back while the browser thought about it.
			if (ended) void given.release();
			else lock = given;
		} catch {
			// Refused (battery low, not allowed): the screen may then go dark, and nothing else depends on it.
		}
	}

	void ask();
	// The browser takes the lock back whenever the page leaves the front.
	document.addEventListener('visibilitychange', ask);
	return () => {
		ended = true;
		document.removeEventListener('visibilitychange', ask);
		void lock?.release();
	};
}
