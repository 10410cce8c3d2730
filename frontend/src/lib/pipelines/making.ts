/** What is moved, taken out and joined: each as the edits that do it. */
import type { DraftExample, DraftPipeline, DraftStage, Edit } from '#lib/contract.ts';
import type { Written } from './written.ts';

/** Edits that take a stage out. */
export function removal({ place, written }: Pick<DraftStage | DraftExample, 'place' | 'written'>): Edit[] {
	return place === null ? [] : [{ kind: 'remove', file: place.file, path: [...place.path], was: written }];
}

type Stages = Pick<DraftPipeline, 'stages'>;

/** Beside which of the stages that are written something stands at an edge: before it, else behind it; null where none is written. */
function besideOf({ stages }: Stages, edge: number): { before: string | number } | { after: string | number } | null {
	const [before, after] = [stages[edge]?.place?.path.at(-1), stages[edge - 1]?.place?.path.at(-1)];
	return before !== undefined ? { before } : after !== undefined ? { after } : null;
}

/** Edits that put a stage to an edge; none where it stands there, or cannot go there. */
export function relocation(pipeline: Stages, index: number, edge: number): Edit[] {
	const { place, written } = pipeline.stages[index] ?? { place: null, written: null };
	const beside = besideOf(pipeline, edge);
	if (place === null || beside === null || edge === index || edge === index + 1 || edge > pipeline.stages.length) return [];
	return [{ kind: 'move', file: place.file, path: [...place.path], was: written, ...beside }];
}

/** Edits that put a stage one further up or down; none where it cannot go there. */
export const shift = (pipeline: Stages, index: number, by: 1 | -1): Edit[] =>
	pipeline.stages[index + by]?.place ? relocation(pipeline, index, by < 0 ? index - 1 : index + 2) : [];

/** Edits that write stages at an edge, as they are, with their comments. */
export function insertion(pipeline: Pick<DraftPipeline, 'stages' | 'place' | 'stages_path'>, edge: number, stages: readonly Written[]): Edit[] {
	const { place, stages_path: path } = pipeline;
	if (path === null) return [];
	const beside = besideOf(pipeline, edge);
	const add = ({ value, text }: Written, where: object): Edit => ({ kind: 'add', file: place.file, path: [...path, 0], value, ...(text !== null && { text }), ...where });
	if (beside !== null && 'before' in beside) return stages.map((stage, at) => add(stage, { before: Number(beside.before) + at }));
	// Each stands before what was put there already.
	return stages.toReversed().map((stage, at) => add(stage, beside ?? (at === 0 ? {} : { before: 0 })));
}
