/** What the parts of this page share: the tree, what is chosen in it, what was found, and whether it can be edited. */
import { createContext, tick } from 'svelte';
import type { Finding, Fix } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { say } from '#lib/text/text.svelte.ts';
import { same, type Path } from './content.ts';
import { Deeds } from './deeds.svelte.ts';
import { Folding } from './folding.svelte.ts';
import type { Draft } from './draft.svelte.ts';
import { fixed } from './fixing.ts';
import { countsOf, foundIn } from './found.ts';
import type { Spot } from './language.ts';
import { PANELS, type PanelName } from './panels.ts';
import { pathAt, placesOf } from './places.ts';
import { inherited, layersOf } from './types.ts';
import { lookupOf, nodeAt, partOf, STATION, treeOf, type Node } from './tree.ts';

/** Where the file editor is asked to go. */
export interface Sight {
	readonly file: string;
	readonly line: number;
	readonly column: number;
}

/** With less than this, in rem, nothing below the form could be read. */
const LEAST = 10;

export class Bench {
	readonly draft: Draft;
	readonly #entry: () => string;
	readonly #may: () => boolean;
	readonly #look: (entry: string, form: boolean) => void;
	/** What else can be written in a field than what the files tell. */
	readonly further: (name: string, spot: Spot) => readonly string[];
	/** Where the file editor is asked to go, each time anew. */
	sight = $state.raw<Sight | null>(null);
	/** The part whose usages are asked for, where that is not the chosen one. */
	sought = $state<string | null>(null);
	/** What is shown of the draft below the form. */
	panel = $state<PanelName>('problems');
	/** How often something was asked for there: each time it comes in sight. */
	asked = $state(0);
	/** How high that is, in rem. */
	below = $state(10);

	readonly tree = $derived.by(() => treeOf(this.draft.files, this.draft.contents));
	readonly lookup = $derived(lookupOf(this.tree));
	readonly found = $derived.by(() =>
		foundIn(this.draft.check?.findings ?? [], this.lookup, this.draft.files)
	);
	readonly counts = $derived(countsOf(this.found, this.lookup));
	/** What is done with parts of the tree. */
	readonly deeds = new Deeds(this);
	/** Which sections of the forms are open. */
	readonly folding = new Folding();
	/** Those that are chosen with the chosen one; whatever else is chosen is chosen alone. */
	#marked = $state.raw<ReadonlySet<string>>(new Set());
	/** The chosen parts, in the order of the tree; the form shows one. */
	readonly selection: readonly Node[] = $derived.by(() => {
		const marked = this.#marked;
		if (marked.size > 1 && marked.has(this.chosen)) return [...this.lookup.byId.values()].filter(({ id }) => marked.has(id));
		return this.node === null ? [] : [this.node];
	});
	readonly #selected = $derived(new Set(this.selection.map(({ id }) => id)));

	constructor(
		draft: Draft,
		entry: () => string,
		may: () => boolean,
		/** Goes to an entry; `form`: to its form, whatever is shown of it now. */
		look: (entry: string, form: boolean) => void,
		further: (name: string, spot: Spot) => readonly string[] = () => []
	) {
		this.further = further;
		this.draft = draft;
		this.#entry = entry;
		this.#may = may;
		this.#look = look;
	}

	/** What was found is known of the draft as it is: it stands where it was found. */
	readonly isCheckedNow = $derived.by(() => this.draft.check !== null && this.draft.check.number === this.draft.number);

	/** Writes what a finding offers; why not, or null. What is being typed counts as done before. */
	async mend(finding: Finding, fix: Fix): Promise<Refusal | null> {
		await this.draft.flush();
		const was = this.draft.text(finding.file);
		const text = this.isCheckedNow ? fixed(was, finding, fix) : null;
		if (text === null) return null; // it is another draft by now, of which it will be told again what is wrong
		return this.draft.change(say().model.problems.mended(fix.was, fix.now), [{ kind: 'text', file: finding.file, was, text }]);
	}

	/** The id of what is chosen. */
	get chosen(): string {
		return this.#entry();
	}

	get node(): Node | null {
		return this.lookup.byId.get(this.chosen) ?? null;
	}

	/** The name of the ability that is chosen, without what stands for its parameters; null for another part. */
	get ability(): string | null {
		return this.node?.kind === 'ability' ? (partOf(this.node)?.replace(/^\w+:/, '') ?? null) : null;
	}

	/** What the chosen one was in, where it is there no more: renamed or deleted, by an undo or by somebody else. */
	get around(): Node | null {
		for (let id = this.chosen; id.includes('#'); ) {
			id = id.slice(0, id.lastIndexOf('#'));
			const found = this.lookup.byId.get(id);
			if (found) return found;
		}
		return this.lookup.byId.get(STATION) ?? null;
	}

	/** Whether this person may change the model. */
	get may(): boolean {
		return this.#may();
	}

	/** Whether the form of what is in `file` cannot be written in. */
	locked(file: string): boolean {
		// Files of a package are compared with their hash: they are changed where they come from.
		return !this.may || file.startsWith('packages/') || (this.draft.files[file]?.wrong ?? null) !== null;
	}

	/** Chooses one, and no other with it. */
	choose(id: string): void {
		this.#marked = new Set();
		if (id !== this.chosen) this.#look(id, false);
	}

	/** Chooses several; the chosen one stays it where it is among them. */
	mark(ids: readonly string[]): void {
		const [first] = ids;
		if (first === undefined) return;
		this.#marked = new Set(ids.length > 1 ? ids : []);
		if (!ids.includes(this.chosen)) this.#look(first, false);
	}

	/** Another one is chosen: those that were with the one before are so no more. */
	settle(): void {
		if (!this.#marked.has(this.chosen)) this.#marked = new Set();
	}

	/** Whether it is chosen, alone or with others. */
	isSelected(id: string): boolean {
		return this.#selected.has(id);
	}

	/** The entry in which a line of a file is. */
	entryAt(file: string, line: number): string {
		const path = pathAt(placesOf(this.draft.text(file)), line);
		return nodeAt(this.lookup, file, path)?.id ?? file;
	}

	/** The entry that is a part, by its name; null where that is none of the tree. */
	entryOf(part: string): string | null {
		for (const node of this.lookup.byId.values()) if (partOf(node) === part) return node.id;
		return null;
	}

	/** What can be told below the form: an example is not run, and nobody changes it. */
	get panels(): readonly PanelName[] {
		return this.draft.example === null ? PANELS : PANELS.filter((panel) => panel !== 'tests' && panel !== 'changes');
	}

	/** Shows something of the draft below the form, with room to see it. */
	show(panel: PanelName): void {
		if (!this.panels.includes(panel)) return;
		this.panel = panel;
		this.asked += 1;
		this.below = Math.max(this.below, LEAST);
	}

	/** Shows where a part is used; null: the chosen one. */
	seek(part: string | null): void {
		this.sought = part;
		this.show('usages');
	}

	/** Leads to a place in a file: chooses what is there, and shows it. */
	lead(sight: Sight): void {
		this.#look(this.entryAt(sight.file, sight.line), true);
		void tick().then(() => (this.sight = { ...sight }));
	}

	/** What an instance has of its type at `path` of its file; null where that is nothing. */
	ofType(file: string, path: Path): ReturnType<typeof inherited> {
		return inherited(layersOf(file, this.draft.contents), path);
	}

	/** What was found at the entry at `path` of a file and, with `within`, in it. */
	problems(file: string, path: Path, within = true): readonly Finding[] {
		return this.found.flatMap(({ finding, path: at }) => {
			const isThere = within ? path.every((step, depth) => at[depth] === step) : same(path, at);
			return finding.file === file && isThere ? [finding] : [];
		});
	}

	/** What a part is called where there is no room for more. */
	label(node: Node): string {
		const { name, file, kind, path } = node;
		const resource = /^(?:packages\/\w+\/)?(?:resources|types)\/(\w+)\.yaml$/.exec(file)?.[1];
		if (kind === 'effect') return `${resource ?? ''}.${String(path[1])}.${name}`;
		return resource !== undefined && path.length > 0 ? `${resource}.${name}` : name;
	}
}

const [useBench, setBench] = createContext<Bench>();
export { setBench, useBench };
