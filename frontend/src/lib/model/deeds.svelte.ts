/**
 * What is done with one or several parts of the tree, each time as one change of the draft: by keys, by buttons, or by
 * dragging. They are done one after the other, each made from what those before have left; what could not be sent is kept.
 */
import type { Edit } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { say } from '#lib/text/text.svelte.ts';
import { toasts } from '#lib/ui/toasts.svelte.ts';
import type { Bench } from './bench.svelte.ts';
import { partsText, pastedAt } from './clipboard.ts';
import type { Yaml } from './commented.ts';
import { duplicatedAll, fewOf, fitting, hindrance, movedTo, removedAll, type Deed, type Hindrance, type Target } from './together.ts';
import { idOf, type Node } from './tree.ts';

/** What is to be done, made from the draft as it is at that moment. */
interface Wanted {
	readonly title: string;
	readonly make: () => readonly Edit[];
	/** It was done. */
	readonly done: () => void;
}

export class Deeds {
	readonly #bench: Bench;
	/** Why something was not done, in words of this page. */
	said = $state<string | null>(null);
	/** Why the server did not do it. */
	refusal = $state.raw<Refusal | null>(null);
	/** What could not be sent: it is kept until it can be, or is let go. */
	waiting = $state.raw<Wanted | null>(null);
	/** What is asked before it is done, and of which parts. */
	asked = $state.raw<{ readonly deed: 'remove' | 'duplicate'; readonly nodes: readonly Node[] } | null>(null);
	/** What was done last, for those who do not see the tree. */
	told = $state('');
	#yaml: Yaml | null = null;
	#before: Promise<unknown> = Promise.resolve();

	constructor(bench: Bench) {
		this.#bench = bench;
	}

	/** Reads what reads and writes YAML: what copies has no time to wait for it. */
	async prepare(): Promise<void> {
		this.#yaml ??= await import('yaml').catch(() => null);
	}

	readonly #isLocked = (file: string): boolean => this.#bench.locked(file);

	/** What is in the way of doing it with these parts. */
	hindrance(deed: Deed, nodes: readonly Node[]): Hindrance | null {
		return hindrance(deed, nodes, this.#bench.lookup, this.#isLocked);
	}

	fitting(deed: Deed, nodes: readonly Node[]): ReturnType<typeof fitting> {
		return fitting(deed, nodes, this.#bench.lookup, this.#isLocked);
	}

	/** Why it cannot be done, in words. */
	why({ why, node, other }: Hindrance): string {
		const { section, kind, together } = say().model;
		const called = (each: Node): string =>
			each.kind === 'section' ? section[each.name as keyof typeof section] : each.kind === 'station' ? kind.station : this.#bench.label(each);
		return together.why[why](called(node), other ? called(other) : '', node.of ?? node.file);
	}

	/** Whether it can be done; why not is said. */
	#allows(deed: Deed, nodes: readonly Node[]): boolean {
		this.said = null;
		this.refusal = null;
		if (nodes.length === 0 || (deed !== 'copy' && !this.#bench.may)) return false;
		const found = this.hindrance(deed, nodes);
		if (found) this.said = this.why(found);
		return found === null;
	}

	readonly #names = (nodes: readonly Node[]): string => fewOf(nodes.map((each) => this.#bench.label(each)), say().model.together.more);

	/** The text that is copied; null where that cannot be, which is said. */
	copy(nodes: readonly Node[]): string | null {
		const text = this.textOf('copy', nodes);
		if (text !== null) toasts.tell(say().model.paste.copied(fewOf(nodes.map(({ name }) => name), say().model.together.more)));
		return text;
	}

	/** The text that is cut, which then goes out of the draft. */
	cut(nodes: readonly Node[]): string | null {
		const text = this.textOf('cut', nodes);
		if (text !== null) this.remove(nodes, say().model.together.cut(nodes.length, this.#names(nodes)));
		return text;
	}

	/** The text of parts as they go to the clipboard; null where they do not, which is said. */
	textOf(deed: 'copy' | 'cut', nodes: readonly Node[]): string | null {
		return this.#yaml && this.#allows(deed, nodes) ? partsText(nodes, this.#bench.draft.contents, (file) => this.#bench.draft.text(file), this.#yaml) : null;
	}

	/** Pastes parts at a node. */
	async paste(text: string, node: Node | null): Promise<void> {
		const yaml = this.#yaml;
		if (!this.#bench.may || !yaml) return;
		const { draft } = this.#bench;
		this.said = null;
		await draft.flush();
		const pasted = () => pastedAt(text, node, this.#bench.lookup, draft.contents, yaml);
		const found = pasted();
		if (!('edits' in found)) {
			const { none, nowhere } = say().model.paste;
			this.said = found.section === null ? none : nowhere(found.section);
			return;
		}
		const title = say().model.change.pasted(found.names);
		let at = found.at;
		const make = (): readonly Edit[] => {
			const now = pasted();
			if (!('edits' in now)) return [];
			at = now.at;
			return now.edits;
		};
		await this.#carry({ title, make, done: () => this.#show(title, at) });
	}

	/** Asks before parts are deleted, which says what names them. */
	ask(deed: 'remove' | 'duplicate', nodes: readonly Node[]): void {
		if (!this.#allows(deed, nodes)) return;
		if (deed === 'duplicate' && nodes.length > 1) return this.#duplicate(nodes);
		this.asked = { deed, nodes };
	}

	remove(nodes: readonly Node[], title = say().model.together.removed(nodes.length, this.#names(nodes))): void {
		const { draft } = this.#bench;
		const [first] = nodes;
		const around = first ? this.#bench.lookup.parents.get(first.id) : undefined;
		void this.#carry({
			title,
			make: () => removedAll(this.#present(nodes), draft.contents, (file) => draft.text(file)),
			done: () => {
				draft.tell(title);
				const { lookup } = this.#bench;
				// With its last part a section of a resource goes as well.
				const next = around && (lookup.byId.get(around.id) ?? lookup.byId.get(around.file));
				this.#bench.choose(next?.id ?? 'station.yaml');
			}
		});
	}

	#duplicate(nodes: readonly Node[]): void {
		const { draft } = this.#bench;
		const title = say().model.together.duplicated(nodes.length, this.#names(nodes));
		let at: ReturnType<typeof duplicatedAll>['at'] = [];
		const make = (): readonly Edit[] => {
			const made = duplicatedAll(this.#present(nodes), this.#bench.lookup, draft.contents, (file) => draft.text(file), this.#yaml);
			at = made.at;
			return made.edits;
		};
		void this.#carry({ title, make, done: () => this.#show(title, at) });
	}

	/** Puts parts beside one of their siblings, found when those before are done; null where they are at the end already. */
	move(nodes: readonly Node[], aim: () => Target | null): Promise<void> {
		const [first] = nodes;
		if (!first || !this.#allows('move', nodes)) return Promise.resolve();
		const { together, change } = say().model;
		const title = nodes.length === 1 ? change.move(this.#bench.label(first)) : together.moved(nodes.length, this.#names(nodes));
		const siblings = (): readonly Node[] => this.#bench.lookup.parents.get(first.id)?.children ?? [];
		let edits: readonly Edit[] = [];
		return this.#carry({
			title,
			make: () => {
				edits = [];
				const target = aim();
				if (target === null) return edits;
				if (this.#present(nodes).length < nodes.length || !this.#bench.lookup.byId.has(target.node.id)) {
					this.said = together.gone;
					return edits;
				}
				return (edits = movedTo(nodes, target, siblings(), this.#bench.draft.contents[first.file]));
			},
			done: () => {
				const list = siblings();
				const place = list.findIndex(({ id }) => id === first.id);
				if (edits.length > 0) this.told = together.placed(title, place + 1, list.length);
			}
		});
	}

	/** Sends what waits once more. */
	again(): void {
		const { waiting } = this;
		this.waiting = null;
		this.refusal = null;
		if (waiting) void this.#carry(waiting);
	}

	/** Lets go what waits, and puts away what was said. */
	close(): void {
		this.said = this.refusal = this.waiting = null;
	}

	#present(nodes: readonly Node[]): Node[] {
		return nodes.flatMap(({ id }) => this.#bench.lookup.byId.get(id) ?? []);
	}

	/** Chooses what was made, and tells it with the way back. */
	#show(title: string, at: readonly { readonly file: string; readonly path: readonly (string | number)[] }[]): void {
		this.#bench.draft.tell(title);
		this.#bench.mark(at.map(({ file, path }) => idOf(file, path)));
	}

	#carry(wanted: Wanted): Promise<void> {
		const run = async (): Promise<void> => {
			const { draft } = this.#bench;
			await draft.flush();
			this.refusal = await draft.change(wanted.title, wanted.make());
			if (this.refusal === null) wanted.done();
			// No answer: whether it was done or not, doing it again from what is there then is right.
			else if (this.refusal.status === null) this.waiting = wanted;
		};
		const carried = this.#before.then(run);
		this.#before = carried;
		return carried;
	}
}
