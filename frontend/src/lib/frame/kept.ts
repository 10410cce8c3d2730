/** What this device remembers of the frame. */
const SLIM = 'rail-slim';

export function keptSlim(): boolean {
	try {
		return localStorage.getItem(SLIM) === 'yes';
	} catch {
		return false; // a browser that keeps nothing
	}
}

export function keepSlim(slim: boolean): void {
	try {
		if (slim) localStorage.setItem(SLIM, 'yes');
		else localStorage.removeItem(SLIM);
	} catch {
		// It holds until the page is closed.
	}
}
