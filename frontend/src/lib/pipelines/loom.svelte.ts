/** The pipelines of the draft as this page knows them, what is chosen of them, and what is shown on their edges. */
import { createContext } from 'svelte';
import type { DraftPipeline, DraftPipelines, Edit, Finding, PipelineRun, RunStep } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Bench } from '#lib/model/bench.svelte.ts';
import { titleAt } from '#lib/model/content.ts';
import { idOf } from '#lib/model/tree.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { language, say } from '#lib/text/text.svelte.ts';
import type { Looked, PartAt } from './address.ts';
import { followed } from './following.ts';
import type { Passing } from './passing.svelte.ts';

const ADDRESS = '/api/v1/model/pipelines';
/** Milliseconds in which the pipelines of a large draft are worked out. */
const PATIENCE = 30_000;

/** Of more values than this a type is said by their number. */
const MOST_VALUES = 4;

/** A moment of a run that is shown on the edges instead of what passes now. */
export interface Shown {
	readonly pipeline: string;
	readonly run: PipelineRun;
	readonly step: number;
}

export class Loom {
	readonly bench: Bench;
	readonly passing: Passing;
	readonly #looked: () => Looked;
	readonly #look: (looked: Looked, replace: boolean) => void;
	/** Leads to where a finding is written. */
	readonly goTo: (finding: Finding) => Promise<void>;
	view = $state.raw<DraftPipelines | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	shown = $state.raw<Shown | null>(null);
	#reading: Promise<void> | null = null;
	#wanted = -1;

	constructor(
		bench: Bench,
		passing: Passing,
		looked: () => Looked,
		look: (looked: Looked, replace: boolean) => void,
		goTo: (finding: Finding) => Promise<void>
	) {
		this.goTo = goTo;
		this.bench = bench;
		this.passing = passing;
		this.#looked = looked;
		this.#look = look;
	}

	get looked(): Looked {
		return this.#looked();
	}

	/** The pipeline that is chosen; null for none, and where there is none of that name. */
	get pipeline(): DraftPipeline | null {
		const { pipeline } = this.looked;
		return pipeline === null ? null : (this.view?.pipelines[pipeline] ?? null);
	}

	/** Whether what is shown is the draft as it is. */
	get isCurrent(): boolean {
		return this.view !== null && this.view.number === this.bench.draft.number;
	}

	choose(pipeline: string | null, part: PartAt | null = null): void {
		this.#look({ ...this.looked, pipeline, part }, false);
	}

	/** The step of the run that is shown of a pipeline; null where what passes now is. */
	stepOf(pipeline: string): RunStep | null {
		return this.shown?.pipeline === pipeline ? (this.shown.run.steps[this.shown.step] ?? null) : null;
	}

	/** Shows a moment of a run on the edges; null for what passes now. */
	show(shown: Shown | null): void {
		this.shown = shown;
	}

	/** The examples were run anew: the one that is shown goes on being shown. */
	refresh(pipeline: string, runs: readonly PipelineRun[]): void {
		const { shown } = this;
		if (shown?.pipeline !== pipeline || shown.run.place === null) return;
		const again = runs.find(({ name }) => name === shown.run.name);
		this.shown = again ? { ...shown, run: again, step: Math.min(shown.step, again.steps.length - 1) } : null;
	}

	/** The fields that are new on an edge: what the stage before it gives. */
	newsAt(pipeline: string, edge: number): readonly string[] {
		const stage = this.view?.pipelines[pipeline]?.stages[edge - 1];
		return stage === undefined ? [] : Object.keys(stage.gives);
	}

	/** Whether the pipeline can be written in now. */
	locked(pipeline: Pick<DraftPipeline, 'place'>): boolean {
		return this.bench.locked(pipeline.place.file);
	}

	/** What a resource is called by people. */
	titleOf(resource: string): string {
		return titleAt(this.bench.draft.contents[`resources/${resource}.yaml`], ['title'], language()) ?? resource;
	}

	/** A type as people read it: one of many values is said by their number. */
	typeText(type: string): string {
		const { kind, values } = this.view?.types[type] ?? { kind: null, values: null };
		const many = values !== null && values !== undefined && values.length > MOST_VALUES;
		return kind === 'enumeration' && many ? say().pipelines.oneOf(values.length) : type;
	}

	/** The pipeline of an entry of the model's tree. */
	pipelineOf(entry: string): string | null {
		const found = Object.values(this.view?.pipelines ?? {}).find(({ place }) => idOf(place.file, place.path) === entry);
		return found?.id ?? null;
	}

	/** Carries edits out that were offered, and waits for what becomes of the pipelines; why not, or null. */
	async change(title: string, edits: readonly object[]): Promise<Refusal | null> {
		const { draft } = this.bench;
		const refusal = await draft.change(title, edits as readonly Edit[]);
		if (refusal === null) await this.follow(draft.latest);
		return refusal;
	}

	/** Asks for the pipelines as they are after change `number`, unless these are known; resolves when they are. */
	follow(number: number): Promise<void> {
		this.#wanted = Math.max(this.#wanted, number);
		this.#reading ??= this.#read().finally(() => (this.#reading = null));
		return this.#reading;
	}

	async #read(): Promise<void> {
		let asked = this.view?.number ?? -1;
		while (asked < this.#wanted) {
			asked = this.#wanted;
			const answer = await request<DraftPipelines>('GET', askedOf(ADDRESS, this.bench.draft.example), { patience: PATIENCE });
			this.refusal = answer.ok ? null : answer.refusal;
			if (answer.ok) this.#take(answer.value);
		}
	}

	/** What is chosen stays so, wherever it stands then; where it is gone, what it was in is chosen. */
	#take(view: DraftPipelines): void {
		const { looked, view: before } = this;
		this.view = view;
		const now = before === null ? looked : followed(looked, before.pipelines, view.pipelines);
		if (now !== looked) this.#look(now, true);
	}
}

const [useLoom, setLoom] = createContext<Loom>();
export { setLoom, useLoom };
