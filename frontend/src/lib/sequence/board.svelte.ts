/** What the parts of the page Operations share: the operations of the draft, what is chosen, and how an order is written. */
import { createContext } from 'svelte';
import type { DraftOperation, DraftOperations, OperationLink } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Draft } from '#lib/model/draft.svelte.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { say } from '#lib/text/text.svelte.ts';
import { titledAlone } from '#lib/wording/titled.svelte.ts';
import { drawn, erased, following, grouped, OPERATIONS, type Together } from './arrows.ts';
import { isBefore, sheetOf } from './sheet.ts';

/** Milliseconds in which a large model is read by a busy machine. */
const PATIENCE = 60_000;

/** How somebody comes to an operation: pointing at it, going through the picture by arrow keys, or to read what is said of it. */
export type Way = 'pointed' | 'walked' | 'led';

export class Board {
	readonly draft: Draft;
	view = $state.raw<DraftOperations | null>(null);
	#refusal = $state.raw<Refusal | null>(null);
	/** Where they lie. */
	readonly sheet = $derived(sheetOf(this.view?.operations ?? {}, this.view?.links ?? []));
	/** Their names, as they come after one another. */
	readonly ordered = $derived(
		Object.keys(this.view?.operations ?? {}).sort((a, b) => (this.sheet.spots.get(a)?.column ?? 0) - (this.sheet.spots.get(b)?.column ?? 0))
	);
	#picked = $state.raw<readonly string[]>([]);
	readonly #may: () => boolean;
	readonly #chosen: () => string | null;
	readonly #look: (name: string | null, way: Way) => void;
	/** How the last was chosen; each time it is another object. */
	came = $state.raw<{ readonly way: Way }>({ way: 'pointed' });
	#asked = 0;

	constructor(draft: Draft, may: () => boolean, chosen: () => string | null, look: (name: string | null, way: Way) => void) {
		this.draft = draft;
		this.#may = may;
		this.#chosen = chosen;
		this.#look = look;
	}

	/** Why the operations are not known. */
	get refusal(): Refusal | null {
		return this.#refusal;
	}

	/** Whether somebody may write the order here. */
	get may(): boolean {
		return this.#may() && this.view?.usable === true && (this.draft.files[OPERATIONS]?.wrong ?? null) === null;
	}

	get chosen(): string | null {
		return this.#chosen();
	}

	get operation(): DraftOperation | null {
		return this.chosen === null ? null : (this.view?.operations[this.chosen] ?? null);
	}

	/** Chooses an operation, or none; who asks for it by keyboard is led to what is said of it. */
	choose(name: string | null, way: Way = 'pointed'): void {
		this.came = { way };
		this.#look(name, way);
	}

	/** Several that are to be put together, in the order in which they were picked. */
	get picked(): readonly string[] {
		return this.may ? this.#picked.filter((name) => name in (this.view?.operations ?? {})) : [];
	}

	/** Picks one more, or leaves it out again; the first goes with the one that is chosen. */
	pick(name: string): void {
		const { picked } = this;
		const first = picked.length === 0 && this.operation !== null && this.chosen !== null && this.chosen !== name ? [this.chosen] : picked;
		this.#picked = first.includes(name) ? first.filter((each) => each !== name) : [...first, name];
	}

	unpick(): void {
		this.#picked = [];
	}

	/** What an operation is called in the language of the page. */
	titleOf(name: string): string {
		return titledAlone(this.view?.operations[name]?.title ?? name);
	}

	/** Reads them as they are after the last change. Of several answers that are on their way only the newest counts. */
	async read(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<DraftOperations>('GET', askedOf('/api/v1/model/operations', this.draft.example), { patience: PATIENCE });
		if (asked !== this.#asked) return;
		if (answer.ok) this.view = answer.value;
		this.#refusal = answer.ok ? null : answer.refusal;
	}

	/** Why `after` cannot come behind `before`; null where it can. */
	hindrance(before: string, after: string): string | null {
		const texts = say().sequence.order;
		const links = this.view?.links ?? [];
		if (before === after) return texts.itself;
		if (links.some((link) => link.before === before && link.after === after && link.reasons.some(({ kind }) => kind === 'sequence' || kind === 'condition')))
			return texts.already(this.titleOf(before), this.titleOf(after));
		return isBefore(after, before, links) ? texts.circle(this.titleOf(after), this.titleOf(before)) : null;
	}

	/** Writes that `after` comes behind `before`; why not, or null. */
	async draw(before: string, after: string): Promise<Refusal | null> {
		const title = say().sequence.order.drawn(this.titleOf(before), this.titleOf(after));
		return this.draft.change(title, drawn(this.draft.contents[OPERATIONS], before, after));
	}

	/** Why those that are picked cannot be put together so; null where they can. */
	groupHindrance(how: Together): string | null {
		const texts = say().sequence.together;
		const { picked } = this;
		const links = this.view?.links ?? [];
		const pairs = picked.flatMap((one, at) => picked.slice(at + 1).map((other) => [one, other] as const));
		if (how === 'sequence') {
			const back = pairs.find(([one, other]) => isBefore(other, one, links));
			return back ? say().sequence.order.circle(this.titleOf(back[1]), this.titleOf(back[0])) : null;
		}
		// What is now written as their order is replaced by it.
		const replaced = following(this.draft.contents[OPERATIONS], picked);
		const others = links.filter(
			({ before, after, reasons }) =>
				!(picked.includes(before) && picked.includes(after) && reasons.every(({ kind, name }) => kind === 'sequence' && name === replaced?.name))
		);
		for (const [one, other] of pairs) {
			if (isBefore(one, other, others)) return texts.ordered(this.titleOf(one), this.titleOf(other));
			if (isBefore(other, one, others)) return texts.ordered(this.titleOf(other), this.titleOf(one));
		}
		const group = (this.view?.groups ?? []).find(
			({ kind, operations }) => (kind === how || kind === 'alternative' || how === 'alternative') && pairs.some((pair) => pair.every((each) => operations.includes(each)))
		);
		return group ? texts.already(texts.kinds[group.kind], group.name) : null;
	}

	/** Writes that those that are picked belong together so; why not, or null. */
	async group(how: Together): Promise<Refusal | null> {
		const title = say().sequence.together.written(
			say().sequence.together.kinds[how],
			this.picked.map((name) => this.titleOf(name))
		);
		return this.draft.change(title, grouped(this.draft.contents[OPERATIONS], how, this.picked));
	}

	/** Whether an arrow can be taken out here: it is written in a plain sequence, and nothing else says the same. */
	isErasable(link: OperationLink): boolean {
		return this.may && erased(this.draft.contents[OPERATIONS], link) !== null;
	}

	/** Takes an arrow out; why not, or null. */
	async erase(link: OperationLink): Promise<Refusal | null> {
		const title = say().sequence.order.erased(this.titleOf(link.before), this.titleOf(link.after));
		return this.draft.change(title, erased(this.draft.contents[OPERATIONS], link) ?? []);
	}
}

const [useBoard, setBoard] = createContext<Board>();
export { setBoard, useBoard };
