/** What is moved, taken out and joined: each as the edits that do it. */
import type { DraftExample, DraftPipeline, DraftStage, Edit } from '#lib/contract.ts';

/** Edits that take a stage out. */
export function removal({ place, written }: Pick<DraftStage | DraftExample, 'place' | 'written'>): Edit[] {
	return place === null ? [] : [{ kind: 'remove', file: place.file, path: [...place.path], was: written }];
}

/** Edits that put a stage one further up or down; none where it cannot go there. */
export function shift({ stages }: Pick<DraftPipeline, 'stages'>, index: number, by: 1 | -1): Edit[] {
	const { place, written } = stages[index] ?? { place: null, written: null };
	const beside = stages[index + by]?.place ?? null;
	const step = beside?.path.at(-1);
	if (place === null || beside === null || step === undefined) return [];
	const where = by < 0 ? { before: step } : { after: step };
	return [{ kind: 'move', file: place.file, path: [...place.path], was: written, ...where }];
}
