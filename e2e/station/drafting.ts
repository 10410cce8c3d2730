/** A model that a test may change: a copy of the usual one, and its draft as an engineer edits it over REST. */
import { cpSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { ERIK, type Station } from './station.ts';

const MODEL = resolve(import.meta.dirname, '../../models/bolt_tightening');
/** Milliseconds in which a small draft is checked. */
const CHECKED = 40_000;

/** A folder of its own with the usual model in it. */
export function copiedModel(): string {
	const folder = join(mkdtempSync(join(tmpdir(), 'model-')), 'bolt_tightening');
	cpSync(MODEL, folder, { recursive: true });
	return folder;
}

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

	/** Puts some text in the place of other text. */
	async change(title: string, ...replacements: Replacement[]): Promise<void> {
		const { body } = await this.ask('GET', 'model/files');
		const files = body['files'] as Record<string, { text: string }>;
		const texts = new Map<string, string>();
		for (const [file, what, by] of replacements) {
			const text = texts.get(file) ?? files[file]?.text ?? '';
			if (!text.includes(what)) throw new Error(`${file} has no ${what}`);
			texts.set(file, text.replace(what, by));
		}
		const edits = [...texts].map(([file, text]) => ({ kind: 'text', file, was: files[file]?.text, text }));
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
