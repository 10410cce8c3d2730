/** The variables that this device keeps in sight, by their names. */
const KEY = 'state-watched';

export function keptWatched(): readonly string[] {
	try {
		const kept: unknown = JSON.parse(localStorage.getItem(KEY) ?? '[]');
		return Array.isArray(kept) ? kept.filter((each) => typeof each === 'string') : [];
	} catch {
		return []; // a browser that keeps nothing, or something else
	}
}

/** Keeps them; where the browser does not let it they last as long as the page. */
export function keepWatched(names: Iterable<string>): void {
	try {
		const kept = [...names];
		if (kept.length > 0) localStorage.setItem(KEY, JSON.stringify(kept));
		else localStorage.removeItem(KEY);
	} catch {
		// As long as the page.
	}
}
