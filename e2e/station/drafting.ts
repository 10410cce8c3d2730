/** The draft of a station, as an engineer edits it over REST. */
import { setTimeout as sleep } from 'node:timers/promises';
import { ERIK, type Station } from './station.ts';

/** Milliseconds in which a small draft is checked. */
const CHECKED = 40_000;

/** What is put in the place of what, in a file. */
export type Replacement = readonly [file: string, what: string, by: string];

interface Answer {
	readonly status: number;
	readonly body: Record<string, unknown>;
}

export class Drafting {
	readonly #station: Station;
	readonly #cookie: string;

	private constructor(station: Station, cookie: string) {
		this.#station = station;
		this.#cookie = cookie;
	}

	/** Erik, who edits. */
	static async of(station: Station): Promise<Drafting> {
		const { name, value } = await station.signIn(ERIK);
		return new Drafting(station, `${name}=${value}`);
	}

	async ask(method: string, path: string, body?: object): Promise<Answer> {
		const headers = { Cookie: this.#cookie, ...(body && { 'Content-Type': 'application/json' }) };
		const answer = await fetch(`${this.#station.url}/api/v1/${path}`, { method, headers, body: body && JSON.stringify(body) });
		const text = await answer.text();
		return { status: answer.status, body: text === '' ? {} : (JSON.parse(text) as Record<string, unknown>) };
	}

	/** The text of each file. */
	async files(): Promise<Map<string, string>> {
		const { body } = await this.ask('GET', 'model/files');
		const files = Object.entries(body['files'] as Record<string, { text: string }>);
		return new Map(files.map(([file, { text }]) => [file, text]));
	}

	/** Makes all files as they were before, if they are not. */
	async restore(before: Map<string, string>): Promise<void> {
		const now = await this.files();
		const edits = [...new Set([...before.keys(), ...now.keys()])]
			.filter((file) => before.get(file) !== now.get(file))
			.map((file) => ({ kind: 'text', file, was: now.get(file) ?? null, text: before.get(file) ?? null }));
		if (edits.length > 0) await this.#write('As it was', edits);
	}

	/** Puts some text in the place of other text. */
	async change(title: string, ...replacements: Replacement[]): Promise<void> {
		const files = await this.files();
		const texts = new Map<string, string>();
		for (const [file, what, by] of replacements) {
			const text = texts.get(file) ?? files.get(file) ?? '';
			if (!text.includes(what)) throw new Error(`${file} has no ${what}`);
			texts.set(file, text.replace(what, by));
		}
		const edits = [...texts].map(([file, text]) => ({ kind: 'text', file, was: files.get(file) ?? null, text }));
		await this.#write(title, edits);
	}

	async #write(title: string, edits: object[]): Promise<void> {
		const { status, body: said } = await this.ask('POST', 'model/changes', { title, edits });
		if (status !== 200) throw new Error(`${title}: ${JSON.stringify(said)}`);
	}

	/** Takes the last change back. */
	async undo(): Promise<void> {
		const { status, body } = await this.ask('POST', 'model/undo', {});
		if (status !== 200) throw new Error(JSON.stringify(body));
	}

	/** Waits until the draft is checked as it is now; the number of its last change. */
	async checked(): Promise<number> {
		const deadline = Date.now() + CHECKED;
		while (Date.now() < deadline) {
			const [draft, check] = await Promise.all([this.ask('GET', 'model'), this.ask('GET', 'model/check')]);
			if (check.body['number'] === draft.body['number'] && check.body['state'] === 'done')
				return Number(check.body['number']);
			await sleep(200);
		}
		throw new Error('the draft was not checked in time');
	}

	/** Saves the draft as a revision; its id. */
	async save(name: string): Promise<string> {
		const { body: draft } = await this.ask('GET', 'model');
		const { status, body } = await this.ask('POST', 'model/revisions', { number: draft['number'], name, message: '' });
		if (status !== 201) throw new Error(JSON.stringify(body));
		return String(body['id']);
	}
}
