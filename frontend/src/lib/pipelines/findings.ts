/** What is found in pipelines, and where of them it is. */
import type { DraftPipeline, DraftPipelines, Finding } from '#lib/contract.ts';
import type { Path } from '#lib/model/content.ts';
import { pathAt, placesOf } from '#lib/model/places.ts';
import { told } from '#lib/text/message.ts';
import type { PartAt } from './address.ts';

/** What a finding says, where its place is seen anyway: without `` `/robot/state` → stage 2 `map`: `` before it. */
export const shortOf = ({ said, message }: Pick<Finding, 'said' | 'message'>): string =>
	told(said, message).replace(/^`[^`]+` → (?:\w+ \d+ `[^`]+`|[^:]*): /, '');

/** All that is found in a pipeline. */
export function findingsIn({ findings, stages, sources }: DraftPipeline): Finding[] {
	return [...findings, ...sources.flatMap((source) => source.findings), ...stages.flatMap((stage) => stage.findings)];
}

export function troublesOf(pipeline: DraftPipeline): { errors: number; warnings: number } {
	const all = findingsIn(pipeline);
	const errors = all.filter(({ severity }) => severity === 'error').length;
	return { errors, warnings: all.length - errors };
}

/** Whether `path` is `way`, or leads on from it. */
export const begins = (path: Path, way: Path): boolean => way.length <= path.length && way.every((step, at) => path[at] === step);

/** Where something of a pipeline is written. */
export interface Sight {
	readonly pipeline: string;
	readonly part: PartAt | null;
	/** The field of the form; null where it is none. */
	readonly field: string | null;
}

/** The pipeline, stage and field that a finding is about; null where it is none of a pipeline. */
export function sightOf({ file, line }: Pick<Finding, 'file' | 'line'>, view: DraftPipelines, text: string): Sight | null {
	const path = pathAt(placesOf(text), line);
	const pipeline = Object.values(view.pipelines).find(({ place }) => place.file === file && begins(path, place.path));
	if (!pipeline) return null;
	const at = pipeline.stages.findIndex(({ place }) => place !== null && begins(path, place.path));
	const stage = pipeline.stages[at];
	const depth = stage?.place ? stage.place.path.length + 1 : pipeline.place.path.length;
	const field = path[depth];
	return {
		pipeline: pipeline.id,
		part: at < 0 ? null : { kind: 'stage', at },
		field: typeof field === 'string' ? field : null
	};
}
