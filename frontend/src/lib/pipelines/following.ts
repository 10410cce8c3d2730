/** What is chosen of pipelines when they have become others: by a change, an undo, or somebody else. */
import type { DraftPipeline } from '#lib/contract.ts';
import type { Looked, PartAt } from './address.ts';

type Staged = { readonly stages: readonly Pick<DraftPipeline['stages'][number], 'id'>[] };
type Pipelines = Readonly<Record<string, Staged & Pick<DraftPipeline, 'resource'>>>;

/** Where a stage stands now that stood at `at`; null where it is gone. One that is another one in its place was written anew. */
export function stageNow(at: number, before: Staged, after: Staged): number | null {
	const id = before.stages[at]?.id;
	if (id === undefined) return at;
	const found = after.stages.findIndex((stage) => stage.id === id);
	if (found >= 0) return found;
	return after.stages.length >= before.stages.length && at < after.stages.length ? at : null;
}

/** Where an edge is now: behind the stage that it was behind. */
export function edgeNow(at: number, before: Staged, after: Staged): number {
	if (at === 0) return 0;
	const stage = stageNow(at - 1, before, after);
	return Math.min(stage === null ? at - 1 : stage + 1, after.stages.length);
}

/** The same as it is now: what was chosen, or what it was in. The very same where nothing of it is another one. */
export function followed(looked: Looked, before: Pipelines, after: Pipelines): Looked {
	const { pipeline, part } = looked;
	const was = pipeline === null ? undefined : before[pipeline];
	if (pipeline === null || was === undefined) return looked;
	const now = after[pipeline];
	if (now === undefined) {
		// A topic or flow is gone: another one of its device, else the whole station.
		const other = Object.entries(after).find(([, { resource }]) => resource === was.resource)?.[0] ?? null;
		return { ...looked, pipeline: other, part: null };
	}
	if (part === null || part.kind === 'variable') return looked;
	const at = part.kind === 'stage' ? stageNow(part.at, was, now) : edgeNow(part.at, was, now);
	if (at === part.at) return looked;
	return { ...looked, part: at === null ? null : ({ kind: part.kind, at } satisfies PartAt) };
}
