/** What the parts of this page share: the tree, what is chosen in it, what was found, and whether it can be edited. */
import { createContext } from 'svelte';
import type { Draft } from './draft.svelte.ts';
import { countsOf, foundIn } from './found.ts';
import type { Spot } from './language.ts';
import { lookupOf, treeOf, type Node } from './tree.ts';

/** Where the file editor is asked to go. */
export interface Sight {
	readonly file: string;
	readonly line: number;
	readonly column: number;
}

export class Bench {
	readonly draft: Draft;
	readonly #entry: () => string;
	readonly #may: () => boolean;
	readonly #look: (entry: string) => void;
	/** What else can be written in a field than what the files tell. */
	readonly further: (name: string, spot: Spot) => readonly string[];
	/** Where the file editor is asked to go, each time anew. */
	sight = $state.raw<Sight | null>(null);

	readonly tree = $derived.by(() => treeOf(this.draft.files, this.draft.contents));
	readonly lookup = $derived(lookupOf(this.tree));
	readonly found = $derived.by(() =>
		foundIn(this.draft.check?.findings ?? [], this.lookup, (file) => this.draft.text(file))
	);
	readonly counts = $derived(countsOf(this.found, this.lookup));

	constructor(
		draft: Draft,
		entry: () => string,
		may: () => boolean,
		look: (entry: string) => void,
		further: (name: string, spot: Spot) => readonly string[] = () => []
	) {
		this.further = further;
		this.draft = draft;
		this.#entry = entry;
		this.#may = may;
		this.#look = look;
	}

	/** The id of what is chosen. */
	get chosen(): string {
		return this.#entry();
	}

	get node(): Node | null {
		return this.lookup.byId.get(this.chosen) ?? null;
	}

	/** Whether this person may change the model. */
	get may(): boolean {
		return this.#may();
	}

	/** Whether the form of what is in `file` cannot be written in. */
	locked(file: string): boolean {
		return !this.may || (this.draft.files[file]?.wrong ?? null) !== null;
	}

	choose(id: string): void {
		if (id !== this.chosen) this.#look(id);
	}

	/** What a part is called where there is no room for more. */
	label(node: Node): string {
		const { name, file, kind, path } = node;
		const resource = /^resources\/(\w+)\.yaml$/.exec(file)?.[1];
		if (kind === 'effect') return `${resource ?? ''}.${String(path[1])}.${name}`;
		return resource !== undefined && path.length > 0 ? `${resource}.${name}` : name;
	}
}

const [useBench, setBench] = createContext<Bench>();
export { setBench, useBench };
