/** What is done to the stages of a pipeline: each is one change of the draft, told with the way back. */
import type { DraftPipeline } from '#lib/contract.ts';
import { Act } from '#lib/command/act.svelte.ts';
import { say } from '#lib/text/text.svelte.ts';
import type { PartAt } from './address.ts';
import { fitsAt, previewed } from './asking.ts';
import { shortOf } from './findings.ts';
import { edgeNow, stageNow } from './following.ts';
import type { Loom } from './loom.svelte.ts';
import { insertion, relocation, removal } from './making.ts';
import type { Spot } from './picture.ts';
import { kindTitle } from './stage-kinds.ts';
import type { Written } from './written.ts';

/** Whether the fields at an edge are known; behind what is wrong nobody can say what fits. */
export const isKnown = ({ edges }: DraftPipeline, edge: number): boolean => (edges[edge]?.fields ?? null) !== null;

/** Milliseconds after which it is said that something is under way. */
const SOON = 400;

/** A stage or an edge as it was when something was asked of it; what was asked before may put it elsewhere. */
interface Pinned {
	readonly pipeline: string;
	readonly at: number;
	readonly before: DraftPipeline | undefined;
}

export class Shaping {
	readonly #loom: Loom;
	readonly act = new Act();
	/** Why nothing came of what was wanted. */
	refused = $state<string | null>(null);
	/** How many changes were asked for and are not done. */
	waiting = $state(0);
	/** They take so long that it is to be said. */
	isSlow = $state(false);
	#timer: ReturnType<typeof setTimeout> | undefined;
	#before: Promise<unknown> = Promise.resolve();

	constructor(loom: Loom) {
		this.#loom = loom;
	}

	/** Where something is put that is chosen: at the edge that is chosen, behind the stage, else at the end. */
	get spot(): Spot | null {
		const { pipeline, looked } = this.#loom;
		if (pipeline === null || pipeline.stages_path === null) return null;
		const { part } = looked;
		const end = pipeline.edges.length - 1;
		const edge = part?.kind === 'edge' ? part.at : part?.kind === 'stage' ? part.at + 1 : end;
		return { pipeline: pipeline.id, edge: Math.min(edge, end) };
	}

	close(): void {
		this.refused = null;
		this.act.refusal = null;
	}

	/** Puts a stage of a kind at an edge, where it fits there. */
	insert(kind: string, { pipeline, edge }: Spot): Promise<boolean> {
		const spot = this.#pinned(pipeline, edge);
		return this.#next(() => this.#insert(kind, { pipeline, edge: this.#edge(spot) }));
	}

	async #insert(kind: string, { pipeline, edge }: Spot): Promise<boolean> {
		const words = say().pipelines;
		const found = this.#may(pipeline);
		if (!found) return false;
		if (!isKnown(found, edge)) return this.#refuse(words.fieldsUnknown);
		const answer = await fitsAt(pipeline, edge);
		if (!answer.ok) {
			this.act.refusal = answer.refusal;
			return false;
		}
		const offer = answer.value.stages.find((each) => each.kind === kind);
		if (!offer?.fits) return this.#refuse(words.cannotStand(kindTitle(kind, say()), words.edgeAt(edge + 1), offer?.reason ?? ''));
		return this.#change(words.change.add(kind, pipeline), offer.edits, pipeline, { kind: 'stage', at: edge });
	}

	/** Puts stages at an edge as they are written, where they fit. */
	paste(stages: readonly Written[], { pipeline, edge }: Spot): Promise<boolean> {
		const spot = this.#pinned(pipeline, edge);
		return this.#next(() => this.#paste(stages, { pipeline, edge: this.#edge(spot) }));
	}

	async #paste(stages: readonly Written[], { pipeline, edge }: Spot): Promise<boolean> {
		const found = this.#may(pipeline);
		if (!found) return false;
		const title = say().pipelines.change.pasted(stages.length, pipeline);
		const edits = insertion(found, edge, stages);
		return (await this.#fits(edits, pipeline)) && this.#change(title, edits, pipeline, { kind: 'stage', at: edge });
	}

	/** Puts a stage to another edge of its pipeline, where it fits; where it stands then, or null. */
	async move(pipeline: string, index: number, edge: number): Promise<number | null> {
		const [from, to] = [this.#pinned(pipeline, index), this.#pinned(pipeline, edge)];
		let at: number | null = null;
		await this.#next(async () => (at = await this.#move(pipeline, this.#stage(from), this.#edge(to))) !== null);
		return at;
	}

	async #move(pipeline: string, index: number | null, edge: number): Promise<number | null> {
		const found = this.#may(pipeline);
		const stage = index === null ? undefined : found?.stages[index];
		if (found && !stage) this.#refuse(say().pipelines.goneMeanwhile);
		if (!found || !stage || index === null) return null;
		const at = edge > index ? edge - 1 : edge;
		const edits = relocation(found, index, edge);
		const title = say().pipelines.change.move(stage.kind, pipeline);
		const isDone = (await this.#fits(edits, pipeline)) && (await this.#change(title, edits, pipeline, { kind: 'stage', at }));
		return isDone ? at : null;
	}

	/** Takes a stage out; whether that was done. */
	remove(pipeline: string, index: number): Promise<boolean> {
		const at = this.#pinned(pipeline, index);
		return this.#next(() => this.#remove(pipeline, this.#stage(at)));
	}

	async #remove(pipeline: string, index: number | null): Promise<boolean> {
		const found = this.#may(pipeline);
		if (!found) return false;
		const stage = index === null ? undefined : found.stages[index];
		if (!stage || index === null) return this.#refuse(say().pipelines.goneMeanwhile);
		if (stage.place === null) return this.#refuse(say().pipelines.implicit);
		return this.#change(say().pipelines.change.remove(stage.kind, pipeline), removal(stage), pipeline, { kind: 'edge', at: index });
	}

	/** Takes a stage out whose text is on the clipboard already; where it stays that is said. */
	async cut(pipeline: string, index: number): Promise<void> {
		if (await this.remove(pipeline, index)) return;
		this.refused = [this.refused, say().pipelines.onlyCopied].filter((each) => each !== null).join(' ');
	}

	/** Does one thing after the other, each with what those before have left. */
	#next(act: () => Promise<boolean>): Promise<boolean> {
		this.waiting += 1;
		this.#timer ??= setTimeout(() => (this.isSlow = true), SOON);
		const done = this.#before.then(act).finally(() => {
			this.waiting -= 1;
			if (this.waiting > 0) return;
			clearTimeout(this.#timer);
			this.#timer = undefined;
			this.isSlow = false;
		});
		this.#before = done.catch(() => false);
		return done;
	}

	#pinned(pipeline: string, at: number): Pinned {
		return { pipeline, at, before: this.#loom.view?.pipelines[pipeline] };
	}

	#stage({ pipeline, at, before }: Pinned): number | null {
		const now = this.#loom.view?.pipelines[pipeline];
		return before && now ? stageNow(at, before, now) : at;
	}

	#edge({ pipeline, at, before }: Pinned): number {
		const now = this.#loom.view?.pipelines[pipeline];
		return before && now ? edgeNow(at, before, now) : at;
	}

	/** Says why nothing comes of it. */
	#refuse(why: string): false {
		this.refused = why;
		return false;
	}

	/** Whether nothing would be wrong that is not wrong now; else it is said what. */
	async #fits(edits: readonly object[], pipeline: string): Promise<boolean> {
		if (edits.length === 0) return false;
		const answer = await previewed(edits);
		if (!answer.ok) {
			this.act.refusal = answer.refusal;
			return false;
		}
		const { refused, findings } = answer.value;
		const wrong = findings.find(({ severity }) => severity === 'error');
		const why = refused ?? (wrong ? shortOf(wrong) : null);
		if (why !== null) this.refused = say().pipelines.doesNotFit(pipeline, why);
		return why === null;
	}

	/** The pipeline, where it can be written in; else that is said. */
	#may(id: string): DraftPipeline | null {
		this.close();
		const pipeline = this.#loom.view?.pipelines[id];
		if (pipeline && pipeline.stages_path !== null && !this.#loom.locked(pipeline)) return pipeline;
		this.refused = say().pipelines.cannotChange(id);
		return null;
	}

	async #change(title: string, edits: readonly object[], pipeline: string, part: PartAt): Promise<boolean> {
		if (edits.length === 0 || !(await this.act.run(() => this.#loom.change(title, edits)))) return false;
		this.#loom.choose(pipeline, part);
		this.#loom.bench.draft.tell(title);
		return true;
	}
}
