/** What a person looks at on the page Pipelines, as it stands in its address. */
import { exampleIn, shownAt } from '#lib/examples/address.ts';

/** A part of a pipeline: a stage or an edge by its place, or a variable. */
export type PartAt =
	| { readonly kind: 'stage' | 'edge'; readonly at: number }
	| { readonly kind: 'variable'; readonly name: string };

export interface Looked {
	/** The pipeline that is chosen; null for all of them. */
	readonly pipeline: string | null;
	/** What of it is chosen; null for the pipeline as a whole. */
	readonly part: PartAt | null;
	/** The example station that is looked at; null for the draft. */
	readonly example: string | null;
}

function partOf(written: string | null): PartAt | null {
	const [, kind, rest = ''] = /^(stage|edge|variable)\.(.+)$/.exec(written ?? '') ?? [];
	if (kind === 'variable') return { kind, name: rest };
	if ((kind === 'stage' || kind === 'edge') && /^\d{1,5}$/.test(rest)) return { kind, at: Number(rest) };
	return null;
}

export function lookedAt(query: Pick<URLSearchParams, 'get'>): Looked {
	const pipeline = query.get('of') || null;
	return { pipeline, part: pipeline === null ? null : partOf(query.get('at')), example: exampleIn(query) };
}

interface Wanted {
	readonly pipeline: string | null;
	readonly part?: PartAt | null;
	readonly example?: string | null;
}

export function addressOf({ pipeline, part = null, example = null }: Wanted): string {
	if (pipeline === null) return shownAt('/pipelines', example);
	const at = part && (part.kind === 'variable' ? `variable.${part.name}` : `${part.kind}.${part.at}`);
	return shownAt('/pipelines', example, { of: pipeline, ...(at !== null && { at }) });
}
