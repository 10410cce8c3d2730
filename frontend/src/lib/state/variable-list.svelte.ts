/**
 * The list of all variables: which are shown, in which order, and which are ticked.
 *
 * Values, ages and standings are looked at anew once a second, however fast the station is; and never so that a row moves
 * under the pointer or away from the focus. Each row that is in sight shows its own value as it comes.
 */
import { createContext, untrack } from 'svelte';
import { SvelteSet } from 'svelte/reactivity';
import type { Question, StationView, Value, Variable } from '#lib/contract.ts';
import { Correction } from '#lib/correct/correction.svelte.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { nameOf, valueOf } from '#lib/wording/names.svelte.ts';
import { arrange, entriesOf, followsValues, type Entry } from './arrange.ts';
import { EVERYTHING, OF_NONE, type Criteria } from './criteria.ts';
import { countsOf, doubtsOf, type Standing } from './standing.ts';
import { keepWatched, keptWatched } from './watched.ts';
import { resourceTitle } from './words.ts';
import { keepHidden, keptHidden, type ColumnId } from './columns.ts';

const EVERY = 1000;

/** A line of the list: a variable, or the resource that those below it belong to. */
export type Line =
	| { readonly variable: string }
	| { readonly resource: string; readonly count: number; readonly folded: boolean };

/** What is being done with variables in a dialog. */
export type Task =
	| { readonly what: 'details' | 'force'; readonly name: string }
	/** With the condition that is offered. */
	| { readonly what: 'breakpoints'; readonly condition: string }
	| { readonly what: 'correct'; readonly correction: Correction }
	/** With the values that were seen as it was opened. */
	| { readonly what: 'confirm'; readonly values: Readonly<Record<string, Value>> };

export class VariableList {
	readonly #station: Station;
	/** The view of the last second. */
	#seen = $state.raw<StationView | null>(null);
	/** The view that the order goes by: that of the last second in which nobody pointed at a row. */
	#arranged = $state.raw<StationView | null>(null);

	criteria = $state.raw<Criteria>(EVERYTHING);
	readonly ticked = new SvelteSet<string>();
	/** Resources whose variables are not shown. */
	readonly folded = new SvelteSet<string>();
	/** What this device keeps in sight, and whether nothing else is shown. */
	readonly watched = new SvelteSet<string>(keptWatched());
	watchedOnly = $state(false);
	/** Columns that are not shown, which this device remembers. */
	hidden = $state.raw<readonly ColumnId[]>(keptHidden());
	/** What resources are called in the picture of the station, as everywhere else. */
	titles = $state.raw<ReadonlyMap<string, string>>(new Map());
	task = $state.raw<Task | null>(null);
	pointed = $state(false);
	focused = $state(false);
	/** Seconds on the controller's clock when it was last looked; null before that. */
	#looked = $state<number | null>(null);

	/** Rows stay where they are. */
	readonly held: boolean = $derived(this.pointed || this.focused || this.task !== null);
	/** Made anew when there are other variables, and not when their values change. */
	readonly #entries: readonly Entry[] = $derived.by(() => {
		const view = this.#station.names.length > 0 ? this.#now() : null;
		return view === null ? [] : entriesOf(view, nameOf, this.titles);
	});
	readonly #resources: ReadonlyMap<string, string> = $derived(new Map(this.#entries.map(({ name, resource }) => [name, resource])));
	/** Seconds on the controller's clock, as of the last second. */
	readonly time: number = $derived.by(() => this.#looked ?? (this.#station.names && (this.#now()?.time ?? 0)));
	readonly all: number = $derived(this.#entries.length);
	readonly #follows: boolean = $derived(followsValues(this.criteria));
	/** The names of those that are shown. */
	readonly names: readonly string[] = $derived(this.#in(this.#follows ? this.#arranged : null));
	/** They stand by resource, each below its own. */
	readonly grouped: boolean = $derived(this.criteria.sort === 'resource');
	readonly lines: readonly Line[] = $derived.by(() => {
		if (!this.grouped) return this.names.map((variable) => ({ variable }));
		const groups = new Map<string, string[]>();
		for (const name of this.names) {
			const resource = this.#resources.get(name) ?? OF_NONE;
			const group = groups.get(resource);
			if (group) group.push(name);
			else groups.set(resource, [name]);
		}
		return [...groups].flatMap(([resource, names]): Line[] => {
			const folded = this.folded.has(resource);
			const below = folded ? [] : names.map((variable) => ({ variable }));
			return [{ resource, count: names.length, folded }, ...below];
		});
	});
	/** How many there are of each kind, all together under the empty word. */
	readonly kinds: Readonly<Record<string, number>> = $derived.by(() => {
		const counts: Record<string, number> = { '': this.#entries.length };
		for (const { kind } of this.#entries) counts[kind] = (counts[kind] ?? 0) + 1;
		return counts;
	});
	/** The order would be another if it did not wait. */
	readonly late: boolean = $derived.by(() => {
		if (!this.held || !this.#follows) return false;
		const now = this.#in(this.#seen);
		return now.length !== this.names.length || now.some((name, place) => name !== this.names[place]);
	});
	readonly counts: Record<Standing, number> = $derived.by(() =>
		countsOf(this.#seen ?? { variables: {}, forces: {}, questions: [] })
	);
	readonly #questions: readonly Question[] = $derived.by(() => this.#station.view?.questions ?? []);
	/** The questions, by the estimates that are in doubt. */
	readonly doubts: ReadonlyMap<string, Question> = $derived(doubtsOf(this.#questions));

	constructor(station: Station) {
		this.#station = station;
	}

	/** A variable as it is now. */
	variable(name: string): Variable | undefined {
		return this.#station.view?.variables[name];
	}

	/** What a resource is called in the list; what belongs to none belongs to the product. */
	titleOf(resource: string | null): string {
		return (resource === null ? undefined : this.titles.get(resource)) ?? resourceTitle(this.#station.view, resource);
	}

	/** Opens the correction of estimates, all at once. */
	correct(names: readonly string[]): void {
		this.task = { what: 'correct', correction: new Correction(this.#station, names) };
	}

	/** Shows the variables of a resource, or not. */
	fold(resource: string): void {
		if (!this.folded.delete(resource)) this.folded.add(resource);
	}

	/** Keeps a variable in sight, or not any more. */
	watch(name: string): void {
		if (!this.watched.delete(name)) this.watched.add(name);
		keepWatched(this.watched);
	}

	/** Shows a column, or not. */
	show(column: ColumnId, shown: boolean): void {
		this.hidden = shown ? this.hidden.filter((each) => each !== column) : [...this.hidden, column];
		keepHidden(this.hidden);
	}

	/** Opens the undoing of the last correction. */
	undo(): void {
		const last = this.#station.view?.last_correction;
		if (!last) return;
		this.task = { what: 'correct', correction: new Correction(this.#station, Object.keys(last.values), last) };
	}

	/** Opens the confirmation of estimates, as they are believed now. */
	confirm(names: readonly string[]): void {
		const believed = names.flatMap((name): [string, Value][] => {
			const value = this.variable(name)?.value ?? null;
			return value === null ? [] : [[name, value]];
		});
		this.task = { what: 'confirm', values: Object.fromEntries(believed) };
	}

	/** Shows what other criteria ask for, as things are now. */
	narrow(criteria: Criteria): void {
		this.criteria = criteria;
		this.arrangeNow();
	}

	/** Sorts by what is so now, whoever points at it. */
	arrangeNow(): void {
		this.#look();
		this.#arranged = this.#seen;
	}

	/** Looks once a second; the result ends that. */
	start(): () => void {
		this.arrangeNow();
		const timer = setInterval(() => {
			this.#look();
			if (!this.held) this.#arranged = this.#seen;
		}, EVERY);
		return () => clearInterval(timer);
	}

	#look(): void {
		this.#seen = this.#station.view;
		this.#looked = this.#seen === null ? null : this.#station.time;
	}

	/** The view of this moment, for what is not to be done anew with each that comes. */
	#now(): StationView | null {
		return untrack(() => this.#station.view);
	}

	#in(view: StationView | null): readonly string[] {
		const judged = view ?? this.#now();
		if (judged === null) return [];
		const names = arrange(this.#entries, this.criteria, judged, valueOf);
		return this.watchedOnly && this.watched.size > 0 ? names.filter((name) => this.watched.has(name)) : names;
	}
}

const [useVariables, setVariables] = createContext<VariableList>();
export { useVariables };

/** Makes the list for all components below. */
export function provideVariables(station: Station): VariableList {
	return setVariables(new VariableList(station));
}
