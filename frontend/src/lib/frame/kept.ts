/** What this device remembers of the frame. */
const SLIM = 'rail-slim';
/** Whether somebody was shown around, or did not want to be. */
const ROUND = 'round';

export function keptSlim(): boolean {
	return kept(SLIM);
}

export function keepSlim(slim: boolean): void {
	keep(SLIM, slim);
}

export function keptRound(): boolean {
	return kept(ROUND);
}

export function keepRound(): void {
	keep(ROUND, true);
}

function kept(key: string): boolean {
	try {
		return localStorage.getItem(key) === 'yes';
	} catch {
		return false; // a browser that keeps nothing
	}
}

function keep(key: string, yes: boolean): void {
	try {
		if (yes) localStorage.setItem(key, 'yes');
		else localStorage.removeItem(key);
	} catch {
		// It holds until the page is closed.
	}
}
