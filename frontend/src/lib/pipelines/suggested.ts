/** What can be written in the form of a stage: the fields that reach it, and the variables of its resource. */
import type { DraftPipelines } from '#lib/contract.ts';
import type { Spot } from '#lib/model/language.ts';
import { begins } from './findings.ts';

const FIELDS = new Set(['field', 'fields', 'of', 'fold', 'reads', 'rename']);
const VARIABLES = new Set(['variable', 'variables']);

/** The names that a field of that key can have at a place of a file. */
export function suggestedAt(name: string, { file, path }: Spot, { pipelines, variables }: DraftPipelines): string[] {
	if (!FIELDS.has(name) && !VARIABLES.has(name)) return [];
	const pipeline = Object.values(pipelines).find(({ place }) => place.file === file && begins(path, place.path));
	const at = pipeline?.stages.findIndex(({ place }) => place !== null && begins(path, place.path)) ?? -1;
	if (!pipeline || at < 0) return [];
	const fields = Object.keys(pipeline.edges[at]?.fields ?? {});
	// On the way out a stage reads variables, and gives fields of the message.
	if (FIELDS.has(name)) return fields;
	if (pipeline.role === 'outgoing' && name === 'variable') return fields;
	return variables
		.filter(({ resource, kind }) => resource === pipeline.resource && (kind === 'measured') === (pipeline.role !== 'outgoing'))
		.map((variable) => variable.name.slice(pipeline.resource.length + 1));
}
