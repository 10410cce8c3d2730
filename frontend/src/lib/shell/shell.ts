/**
 * The files that the watch needs to open, kept in the browser: so it opens at once, and says itself that it is not live
 * while the server is away.
 *
 * The page is asked for from the server first, so that a new build is seen as soon as there is one; what was kept is for
 * when no answer comes. Nothing but files of the build is ever kept. The page of a new build takes the place of the one
 * before only when all that it names is there, so that what is kept always fits together.
 */

export const PAGE = '/operator';
/** The addresses of files whose names carry a hash of their content: what was read once never changes. */
const IMMUTABLE = '/_app/immutable/';
/** Milliseconds to wait for the server where there is something to show without it. */
const PATIENCE = 1500;

/** The part of a browser's cache that is used. */
export interface Kept {
	match(address: string): Promise<Response | undefined>;
	put(address: string, response: Response): Promise<void>;
	delete(address: string): Promise<boolean>;
	keys(): Promise<readonly { readonly url: string }[]>;
}

type Load = (address: string, init?: RequestInit) => Promise<Response>;

/** The addresses of all files that the built document `html` names. They are relative to the root, where it lies. */
export function filesOf(html: string): string[] {
	const named = html.matchAll(/(?:href|src)="\.\/([^"]+)"|import\("\.\/([^"]+)"\)|(?:href|src)="\/([^"/][^"]*\.\w+)"/g);
	return [...new Set([...named].map(([, one, two, three]) => `/${one ?? two ?? three ?? ''}`))];
}

export class Shell {
	readonly #kept: Kept;
	readonly #load: Load;
	/** What was asked for since the worker began, which the page that is there now may have read later. */
	readonly #asked = new Set<string>();

	constructor(kept: Kept, load: Load) {
		this.#kept = kept;
		this.#load = load;
	}

	/** Reads the page and keeps it with all its files. */
	async install(): Promise<void> {
		await this.#keep(await this.#load(PAGE, { cache: 'no-cache' }));
	}

	/** The page: as the server has it now, and kept from then on; as it was kept where the server does not answer. */
	async page(later: (work: Promise<void>) => void): Promise<Response> {
		const loading = this.#load(PAGE, { cache: 'no-cache' });
		later(
			loading.then(
				(response) => this.#keep(response.clone()),
				() => undefined
			)
		);
		return this.#orKept(PAGE, loading.then((response) => response.clone()));
	}

	/** A file of the build. */
	async file(address: string): Promise<Response> {
		if (!address.startsWith(IMMUTABLE)) return this.#orKept(address, this.#load(address));
		this.#asked.add(address);
		const found = await this.#kept.match(address);
		if (found !== undefined) return found;
		const response = await this.#load(address);
		if (response.ok) await this.#kept.put(address, response.clone());
		return response;
	}

	/** What is being loaded; what was kept instead if it fails, or takes too long. */
	async #orKept(address: string, loading: Promise<Response>): Promise<Response> {
		const kept = await this.#kept.match(address);
		if (kept === undefined) return loading;
		const late = new Promise<Response>((resolve) => setTimeout(() => resolve(kept), PATIENCE));
		// A proxy before a server that is away answers too.
		return Promise.race([loading.then((response) => (response.status < 500 ? response : kept)).catch(() => kept), late]);
	}

	async #keep(page: Response): Promise<void> {
		if (!page.ok) throw new Error(`the page is answered with ${page.status}`);
		const html = await page.clone().text();
		const files = filesOf(html);
		const fresh = new Map<string, Response>();
		for (const address of files) {
			const immutable = address.startsWith(IMMUTABLE);
			if (immutable && (await this.#kept.match(address)) !== undefined) continue;
			const response = await this.#load(address, immutable ? {} : { cache: 'no-cache' });
			if (!response.ok) throw new Error(`${address} is answered with ${response.status}`);
			if (immutable) await this.#kept.put(address, response);
			else fresh.set(address, response);
		}
		for (const [address, response] of fresh) await this.#kept.put(address, response);
		await this.#kept.put(PAGE, page);
		await this.#drop(new Set([PAGE, ...files]));
	}

	/** Drops what only earlier builds needed. */
	async #drop(needed: ReadonlySet<string>): Promise<void> {
		for (const { url } of await this.#kept.keys()) {
			const address = new URL(url, 'https://here.invalid').pathname;
			if (!needed.has(address) && !this.#asked.has(address)) await this.#kept.delete(address);
		}
	}
}
