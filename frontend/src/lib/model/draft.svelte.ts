/**
 * The draft of the model as this page knows it: one for all engineers of the station; or an example, which is read in the
 * same way and never changes.
 *
 * The stream says what is new; a file is read again when its digest is another one. What this page does itself comes back
 * with the answer, and counts at once.
 */
import type { DraftChange,
	DraftView,
	Edit,
	FileMark,
	FilesView,
	FileView,
	ModelCheck } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { ENDED } from '#lib/stream/connection.ts';
import { say } from '#lib/text/text.svelte.ts';
import { toasts } from '#lib/ui/toasts.svelte.ts';
import { WorkshopSeen } from '#lib/workshop/workshop.svelte.ts';
import { asJson, type Json } from './content.ts';
import type { Writing } from './writing.svelte.ts';

const ADDRESS = '/api/v1/model';
/** Of more files than this all are asked for. */
const MOST_NAMED = 50;
/** Milliseconds in which an edit of a large model is carried out. */
const PATIENCE = 20_000;

/** The last change is another one by now. */
function notLast(): Refusal {
	const { notLast: title, useUndo: detail } = say().model.remove;
	return { title, detail, status: null, kind: null, retryAfter: null, place: null };
}

export class Draft {
	/** The example station that it is; null for the draft of the station. */
	readonly example: string | null;
	/** What the stream says. */
	readonly seen: WorkshopSeen;
	files = $state.raw<Readonly<Record<string, FileView>>>({});
	/** What was last read of each file, also where its text cannot be read now. */
	contents = $state.raw<Readonly<Record<string, Json | undefined>>>({});
	changes = $state.raw<readonly DraftChange[]>([]);
	undo = $state<string | null>(null);
	redo = $state<string | null>(null);
	/** All files were read once. */
	whole = $state(false);
	#refusal = $state.raw<Refusal | null>(null);
	/** What was typed and is not in the draft, by where it belongs. */
	unwritten = $state.raw<ReadonlyMap<string, Writing<unknown>>>(new Map());
	readonly #writings = new Map<string, Writing<unknown>>();
	/** The change after which each file was read. */
	readonly #read = new Map<string, number>();
	#reading = false;
	#asked = 0;
	/** What this page did last. */
	#done = -1;

	constructor(example: string | null = null) {
		this.example = example;
		this.seen = new WorkshopSeen(example);
	}

	/** Connects to the server's stream; the result disconnects. `ended` is called where the session has. */
	attach(ended: () => void): () => void {
		void this.#begin(); // meanwhile the stream connects
		return this.seen.attach(
			(isNew) => this.#told(isNew),
			(code) => {
				if (code === ENDED) ended();
			}
		);
	}

	/** Whether the stream is heard. */
	get live(): boolean {
		return this.seen.live;
	}

	/** The number of the last change; null before anything was heard. */
	get number(): number | null {
		return this.seen.view?.number ?? null;
	}

	/** The number of the last change that is known of, also where the stream has not told of it yet. */
	get latest(): number {
		return Math.max(this.number ?? -1, this.#done);
	}

	get marks(): Readonly<Record<string, FileMark>> {
		return this.seen.view?.files ?? {};
	}

	get check(): ModelCheck | null {
		return this.seen.view?.check ?? null;
	}

	/** Why it is not known. */
	get refusal(): Refusal | null {
		return this.seen.refusal ?? this.#refusal;
	}

	/** The text of a file; empty where there is none. */
	text(path: string): string {
		return this.files[path]?.text ?? '';
	}

	/** Carries edits out; why not, or null. */
	async change(title: string, edits: readonly Edit[]): Promise<Refusal | null> {
		if (edits.length === 0) return null;
		return this.#act('changes', { title: title.slice(0, 300), edits });
	}

	/** Calls a part otherwise, wherever it is named. What is being typed counts as done before. */
	async rename(part: string, name: string): Promise<Refusal | null> {
		await this.flush();
		return this.#act('rename', { part, name });
	}

	/** Takes back, or does again, what this person did last. What is being typed counts as done before. */
	async again(what: 'undo' | 'redo'): Promise<Refusal | null> {
		await this.flush();
		return this.#act(what, {});
	}

	/** Tells a change with the way back, which takes back that one and no other. */
	tell(title: string): void {
		toasts.tell(title, { act: () => (this.undo === title ? this.again('undo') : Promise.resolve(notLast())) });
	}

	/** Sends whatever was typed. */
	async flush(): Promise<void> {
		await Promise.all([...this.#writings.values()].map((each) => each.flush()));
	}

	/** What is written at `key`, made unless it is still there. */
	writing<Value>(key: string, make: () => Writing<Value>): Writing<Value> {
		const before = this.#writings.get(key);
		if (before?.dirty) return before as Writing<Value>;
		const writing = make();
		this.#writings.set(key, writing as Writing<unknown>);
		return writing;
	}

	/** Its field goes out of sight: what was typed is sent, and kept where that is refused. */
	async leave(key: string, writing: Writing<unknown>): Promise<void> {
		await writing.flush();
		if (this.#writings.get(key) !== writing) return;
		if (writing.dirty) this.unwritten = new Map([...this.unwritten, [key, writing]]);
		else this.#writings.delete(key);
	}

	/** Something that was not written is in sight again, or let go. */
	settle(key: string): void {
		if (!this.unwritten.has(key)) return;
		this.unwritten = new Map([...this.unwritten].filter(([each]) => each !== key));
	}

	/** Whether something was typed that is not in the draft. */
	get isUnwritten(): boolean {
		return [...this.#writings.values()].some((each) => each.dirty);
	}

	async #act(what: 'changes' | 'rename' | 'undo' | 'redo', body: object): Promise<Refusal | null> {
		const answer = await request<FilesView>('POST', `${ADDRESS}/${what}`, { body, patience: PATIENCE });
		if (answer.ok) {
			this.#take(answer.value);
			return null;
		}
		// Both versions are shown where it was refused because of somebody else's: theirs must be there first.
		if (answer.refusal.status === 409 || answer.refusal.status === 422) await this.#load(null);
		return answer.refusal;
	}

	#told(isNew: boolean): void {
		this.#refusal = null;
		this.#forget();
		void this.#follow();
		if (isNew) void this.#describe();
	}

	/** Files that are gone. */
	#forget(): void {
		const gone = Object.keys(this.files).filter((path) => !this.marks[path]?.digest);
		// A file that this page has just made may not have been told of yet.
		const old = gone.filter((path) => (this.#read.get(path) ?? 0) <= (this.number ?? 0));
		if (old.length === 0) return;
		const drop = <Value>(all: Readonly<Record<string, Value>>): Record<string, Value> =>
			Object.fromEntries(Object.entries(all).filter(([path]) => !old.includes(path)));
		this.files = drop(this.files);
		this.contents = drop(this.contents);
	}

	/** Reads all there is, whatever the stream will say. */
	async #begin(): Promise<void> {
		this.#reading = true;
		await this.#load(null);
		this.#reading = false;
		if (this.number !== null) await this.#follow();
	}

	/** Reads what has become another one, until all is as the stream says. */
	async #follow(): Promise<void> {
		if (this.#reading) return;
		this.#reading = true;
		for (let asked = 0; asked < 5; asked++) {
			const others = Object.entries(this.marks)
				.filter(([path, { digest }]) => digest !== null && this.files[path]?.digest !== digest)
				.map(([path]) => path)
				.filter((path) => (this.#read.get(path) ?? -1) < (this.number ?? 0));
			if (others.length === 0) break;
			if (!(await this.#load(others.length > MOST_NAMED ? null : others))) break;
		}
		this.#reading = false;
		if (Object.values(this.marks).length > 0) this.whole = true;
	}

	async #load(paths: readonly string[] | null): Promise<boolean> {
		const named = (paths ?? []).map((path): [string, string] => ['path', path]);
		const answer = await request<FilesView>('GET', askedOf(`${ADDRESS}/files`, this.example, named), { patience: PATIENCE });
		if (answer.ok) this.#take(answer.value);
		else this.#refusal = answer.refusal;
		return answer.ok;
	}

	#take({ number, files }: FilesView): void {
		this.#done = Math.max(this.#done, number);
		const shown = { ...this.files };
		const contents = { ...this.contents };
		for (const [path, file] of Object.entries(files)) {
			if (number < (this.#read.get(path) ?? 0)) continue;
			this.#read.set(path, number);
			if (file === null) {
				delete shown[path];
				delete contents[path];
			} else if (shown[path]?.digest !== file.digest) {
				shown[path] = file;
				if (file.wrong === null) contents[path] = asJson(file.content);
			}
		}
		this.files = shown;
		this.contents = contents;
	}

	/** Who did what, and what can be undone. */
	async #describe(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<DraftView>('GET', askedOf(ADDRESS, this.example));
		if (asked !== this.#asked) return;
		if (!answer.ok) {
			this.#refusal = answer.refusal;
			return;
		}
		this.changes = answer.value.changes;
		this.undo = answer.value.undo;
		this.redo = answer.value.redo;
	}
}
