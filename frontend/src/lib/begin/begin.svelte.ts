/** What the parts of this page share: what is written, what becomes of it as the server says, and what is wrong with it. */
import { createContext, tick } from 'svelte';
import { SvelteSet } from 'svelte/reactivity';
import type { Outline, OutlineView, Templates } from '#lib/contract.ts';
import { unread, type Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { language, say } from '#lib/text/text.svelte.ts';
import type { Kept } from './kept.ts';
import { keyOf, unsaid, wrongIn, type Key, type Wrong } from './places.ts';
import { neverText } from './sentences.ts';
import { blank, isWritten, numbered, outlineOf, sketchOf, type Sketch } from './sketch.ts';
import type { Step } from './steps.ts';
import { thingsOf, type Thing } from './things.ts';

const ADDRESS = '/api/v1/model/outlines';
/** Milliseconds without a key after which it is asked what becomes of it, and after which again where there was no answer. */
const REST = 300;
const AGAIN = 3000;

export class Begin {
	/** What is written. */
	sketch = $state<Sketch>(blank());
	templates = $state.raw<Readonly<Record<string, Outline>>>({});
	/** The last documents that there were; older than what is written while `isWhole` is not so. */
	files = $state.raw<Readonly<Record<string, string>>>({});
	errors = $state.raw<OutlineView['errors']>([]);
	/** What the server said is wrong with what was written when it was last asked. */
	#told = $state.raw<readonly Wrong[]>([]);
	/** Why it is not known what becomes of it. */
	refusal = $state.raw<Refusal | null>(null);
	/** Where somebody was and went on: what is wrong there is said. */
	readonly #left = new SvelteSet<Key>();
	readonly leftSteps = new SvelteSet<Step>();
	/** The device that is looked at. */
	device = $state<number | null>(null);
	/** What was asked last that was answered. */
	#answered = $state<string | null>(null);
	#asked = 0;
	readonly #kept: Kept;
	/** Another tab has written something else than this one, which neither takes the place of: a person chooses. */
	split = $state(false);
	/** Another tab has gone on, and its answers are here now. */
	follows = $state(false);
	readonly #go: (step: Step) => Promise<void>;

	readonly things: readonly Thing[] = $derived.by(() => thingsOf(this.sketch, say().begin.values));
	readonly outline: Outline = $derived.by(() =>
		// A title with braces would be said to be wrong once more.
		outlineOf(this.sketch, (never) => (never.facts.length > 0 ? neverText(never, this.things, say()).replaceAll(/[{}]/g, '').slice(0, 200) : ''))
	);
	readonly asked: string = $derived(JSON.stringify(this.outline));
	readonly #here: readonly Wrong[] = $derived.by(() => unsaid(this.sketch, say().begin));
	/** All that is wrong, each place once. */
	readonly wrong: readonly Wrong[] = $derived.by(() => {
		const known = new Set(this.#here.map(({ key }) => key));
		return [...this.#told.filter(({ key }) => !known.has(key)), ...this.#here];
	});
	/** What is known is of what is written now. */
	readonly isKnown: boolean = $derived(this.#answered === this.asked);
	/** The documents are those of what is written now. */
	readonly isWhole: boolean = $derived(this.isKnown && this.wrong.length === 0);
	/** Something is written that would be lost. */
	readonly isWritten: boolean = $derived.by(() => isWritten(this.sketch, this.templates));

	constructor(kept: Kept, go: (step: Step) => Promise<void>) {
		this.#kept = kept;
		this.#go = go;
		const before = kept.read();
		const aside = kept.aside();
		this.split = aside !== null && JSON.stringify(aside) !== JSON.stringify(before);
		const begun = this.split ? aside : before;
		if (begun !== null) this.sketch = begun;
	}

	/** Reads what one can begin with. */
	async begin(): Promise<void> {
		const answer = await request<Templates>('GET', `${ADDRESS}?${new URLSearchParams({ language: language() })}`);
		if (answer.ok) this.templates = answer.value.templates;
		else this.refusal = answer.refusal;
	}

	/** Keeps what is written, for when this page is opened again. */
	keep(): void {
		const now = this.#now;
		if (!this.split && this.#kept.keep(now)) return;
		this.split = true;
		this.#kept.setAside(now);
	}

	/** What is to be kept; null for nothing. */
	get #now(): Sketch | null {
		const { sketch } = this;
		return sketch.title === '' && !this.isWritten && sketch.template === null ? null : sketch;
	}

	/** Looks at what another tab has written: this one goes on from that, unless both wrote at the same moment. */
	meet(): void {
		const found = this.split ? null : this.#kept.elsewhere();
		if (found === null) return;
		if (found.newer) return this.#follow();
		this.split = true;
		this.#kept.setAside(this.#now);
	}

	#follow(): void {
		this.sketch = this.#kept.read() ?? blank();
		this.follows = true;
	}

	/** Which of both stays, where two tabs have written something else: what is here, or what the other one wrote. */
	settle(which: 'here' | 'there'): void {
		this.split = false;
		if (which === 'there') {
			this.#kept.setAside(null);
			this.#follow();
		} else this.#kept.force($state.snapshot(this.sketch) as Sketch);
	}

	/** Asks what becomes of `asked` when nothing is typed for a moment; the result takes that back. */
	ask(asked: string): () => void {
		let timer = setTimeout(() => void look(), REST);
		const look = async (): Promise<void> => {
			const number = ++this.#asked;
			const of = $state.snapshot(this.sketch);
			const answer = await request<OutlineView>('POST', `${ADDRESS}/preview`, { body: JSON.parse(asked) as Outline });
			if (number !== this.#asked) return;
			// Nothing is changed by it: no answer leaves no doubt.
			this.refusal = answer.ok ? null : answer.refusal.status === null ? unread() : answer.refusal;
			if (answer.ok) this.#take(answer.value, of, asked);
			// What is refused as it is would be refused again.
			else if (answer.refusal.status === null || answer.refusal.status >= 500) timer = setTimeout(() => void look(), AGAIN);
		};
		return () => {
			clearTimeout(timer);
			this.#asked += 1; // what is still on its way is old
		};
	}

	#take({ files, problems, errors }: OutlineView, of: Sketch, asked: string): void {
		if (Object.keys(this.templates).length === 0) void this.begin(); // when these were asked for there was no answer
		this.#told = wrongIn(problems, of);
		if (this.wrong.length === 0) this.files = files;
		this.errors = errors;
		this.#answered = asked;
	}

	/** Somebody has gone on from a field. */
	leave(key: string | undefined): void {
		if (key !== undefined) this.#left.add(key as Key);
	}

	/** Whether what is wrong there is said. */
	isSaid({ key, step }: Wrong): boolean {
		return this.leftSteps.has('look') || this.leftSteps.has(step) || this.#left.has(key);
	}

	/** What is wrong with a field, once it was left; null where that is nothing. */
	why(id: number | null, field: string): string | null {
		const key = keyOf(id, field);
		const wrong = this.wrong.find((each) => each.key === key);
		return wrong && this.isSaid(wrong) ? wrong.why : null;
	}

	/** What is said to be wrong in a step. */
	wrongOf(step: Step): readonly Wrong[] {
		return this.wrong.filter((each) => each.step === step && this.isSaid(each));
	}

	/** Leads to the field in which something is wrong, or to what it is in. */
	async lead({ key, step }: Wrong): Promise<void> {
		this.leftSteps.add(step);
		await this.#go(step);
		await tick();
		const [of = '', field = ''] = key.split(/\.(.*)/s);
		for (const at of [`${of}.${field}`, `${of}.${field.split('.')[0] ?? ''}`, `${of}.name`]) {
			const found = document.querySelector<HTMLElement>(`[data-at="${CSS.escape(at)}"]`);
			if (found === null) continue;
			found.scrollIntoView({ block: 'center' });
			found.focus();
			return;
		}
	}

	/** A number for something new. */
	number(): number {
		return numbered(this.sketch);
	}

	/** Begins with a template; null: with nothing. The title stays, where somebody has written one. */
	take(template: string | null): void {
		const { title, template: before } = this.sketch;
		const outline = template === null ? undefined : this.templates[template];
		const isOwn = title.trim() !== '' && title !== (before === null ? undefined : this.templates[before]?.title);
		const begun = outline === undefined ? blank() : sketchOf(outline, template);
		this.#start({ ...begun, title: isOwn ? title : begun.title });
	}

	/** Lets go of all that was written. */
	startOver(): void {
		this.#start(blank());
		this.split = this.follows = false;
		this.#kept.force(null);
	}

	#start(sketch: Sketch): void {
		this.sketch = sketch;
		this.device = null;
		this.files = {};
		this.#told = [];
		this.#left.clear();
		this.leftSteps.clear();
	}
}

const [useBegin, setBegin] = createContext<Begin>();
export { setBegin, useBegin };
