/** What is done to the stages of a pipeline: each is one change of the draft, told with the way back. */
import type { DraftPipeline, Json } from '#lib/contract.ts';
import { Act } from '#lib/command/act.svelte.ts';
import { say } from '#lib/text/text.svelte.ts';
import type { PartAt } from './address.ts';
import { fitsAt, previewed } from './asking.ts';
import { shortOf } from './findings.ts';
import type { Loom } from './loom.svelte.ts';
import { insertion, relocation, removal } from './making.ts';
import type { Spot } from './picture.ts';

/** Whether the fields at an edge are known; behind what is wrong nobody can say what fits. */
export const isKnown = ({ edges }: DraftPipeline, edge: number): boolean => (edges[edge]?.fields ?? null) !== null;

export class Shaping {
	readonly #loom: Loom;
	readonly act = new Act();
	/** Why nothing came of what was wanted. */
	refused = $state<string | null>(null);
	/** Something is under way. */
	busy = $state(false);

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
	insert(kind: string, spot: Spot): Promise<void> {
		return this.#once(() => this.#insert(kind, spot));
	}

	async #insert(kind: string, { pipeline, edge }: Spot): Promise<void> {
		const found = this.#may(pipeline);
		if (!found) return;
		if (!isKnown(found, edge)) {
			this.refused = say().pipelines.fieldsUnknown;
			return;
		}
		const answer = await fitsAt(pipeline, edge);
		if (!answer.ok) {
			this.act.refusal = answer.refusal;
			return;
		}
		const offer = answer.value.stages.find((each) => each.kind === kind);
		if (!offer?.fits) {
			this.refused = say().pipelines.cannotStand(kind, say().pipelines.edgeAt(edge + 1), offer?.reason ?? '');
			return;
		}
		await this.#change(say().pipelines.change.add(kind, pipeline), offer.edits, pipeline, { kind: 'stage', at: edge });
	}

	/** Puts stages at an edge as they are written, where they fit. */
	paste(values: readonly Json[], spot: Spot): Promise<void> {
		return this.#once(() => this.#paste(values, spot));
	}

	async #paste(values: readonly Json[], { pipeline, edge }: Spot): Promise<void> {
		const found = this.#may(pipeline);
		if (!found) return;
		const title = say().pipelines.change.pasted(values.length, pipeline);
		const edits = insertion(found, edge, values);
		if (await this.#fits(edits, pipeline)) await this.#change(title, edits, pipeline, { kind: 'stage', at: edge });
	}

	/** Puts a stage to another edge of its pipeline, where it fits. */
	move(pipeline: string, index: number, edge: number): Promise<void> {
		return this.#once(() => this.#move(pipeline, index, edge));
	}

	async #move(pipeline: string, index: number, edge: number): Promise<void> {
		const found = this.#may(pipeline);
		const stage = found?.stages[index];
		if (!found || !stage) return;
		const at = edge > index ? edge - 1 : edge;
		const edits = relocation(found, index, edge);
		const title = say().pipelines.change.move(stage.kind, pipeline);
		if (await this.#fits(edits, pipeline)) await this.#change(title, edits, pipeline, { kind: 'stage', at });
	}

	remove(pipeline: string, index: number): Promise<void> {
		return this.#once(() => this.#remove(pipeline, index));
	}

	async #remove(pipeline: string, index: number): Promise<void> {
		const stage = this.#may(pipeline)?.stages[index];
		if (!stage) return;
		if (stage.place === null) this.refused = say().pipelines.implicit;
		else await this.#change(say().pipelines.change.remove(stage.kind, pipeline), removal(stage), pipeline, { kind: 'edge', at: index });
	}

	/** Does one thing at a time: what is asked for meanwhile is left out. */
	async #once(act: () => Promise<void>): Promise<void> {
		if (this.busy) return;
		this.busy = true;
		try {
			await act();
		} finally {
			this.busy = false;
		}
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

	/** The pipeline, where it can be written in. */
	#may(id: string): DraftPipeline | null {
		this.close();
		const pipeline = this.#loom.view?.pipelines[id];
		return pipeline && pipeline.stages_path !== null && !this.#loom.locked(pipeline) ? pipeline : null;
	}

	async #change(title: string, edits: readonly object[], pipeline: string, part: PartAt): Promise<void> {
		if (edits.length === 0 || !(await this.act.run(() => this.#loom.change(title, edits)))) return;
		this.#loom.choose(pipeline, part);
		this.#loom.bench.draft.tell(title);
	}
}
