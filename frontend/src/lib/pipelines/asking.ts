/** What the server is asked about the pipelines of the draft, or of an example. */
import type { PipelineFits, PipelinePreview, PipelineRuns, RecordedExample } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import { request, type Answer } from '#lib/rest/request.ts';

const ADDRESS = '/api/v1/model/pipelines';
/** Milliseconds in which a question about a large draft is answered. */
const PATIENCE = 30_000;

/** What could be put at an edge; with a field of it, also what that could become. */
export function fitsAt(pipeline: string, edge: number, field: string | null = null): Promise<Answer<PipelineFits>> {
	const body = { pipeline, edge, ...(field !== null && { field }) };
	return request('POST', `${ADDRESS}/suggestions`, { body, patience: PATIENCE });
}

/** What would come of edits; nothing is changed. */
export function previewed(edits: readonly object[]): Promise<Answer<PipelinePreview>> {
	return request('POST', `${ADDRESS}/preview`, { body: { edits }, patience: PATIENCE });
}

/** How the examples of a pipeline end. */
export function examplesOf(pipeline: string, example: string | null): Promise<Answer<PipelineRuns>> {
	return request('POST', askedOf(`${ADDRESS}/examples`, example), { body: { pipeline }, patience: PATIENCE });
}

/** What comes of one message, or of what stands for it. */
export function triedWith(pipeline: string, given: object, example: string | null): Promise<Answer<PipelineRuns>> {
	return request('POST', askedOf(`${ADDRESS}/test-runs`, example), { body: { pipeline, steps: [{ at: 0, given }] }, patience: PATIENCE });
}

/** Makes an example of what the station has heard or said last. */
export function recorded(pipeline: string, name: string): Promise<Answer<RecordedExample>> {
	return request('POST', `${ADDRESS}/recordings`, { body: { pipeline, name }, patience: PATIENCE });
}
