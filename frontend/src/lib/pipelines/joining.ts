/** What it means that one box of the graph is drawn to another. */
import type { DraftPipelines } from '#lib/contract.ts';
import type { Box } from './picture.ts';

export interface Join {
	readonly pipeline: string;
	readonly edge: number;
	readonly field: string | null;
	/** What it becomes, or the source; null where that is still to be chosen. */
	readonly target: string | null;
	/** A flow gets a further source. */
	readonly sources: boolean;
}

/** The join that is meant; null where it means nothing. Whether it fits is the server's to say. */
export function joinOf(from: Box, to: Box, { pipelines }: Pick<DraftPipelines, 'pipelines'>): Join | null {
	const ended = (id: string): number => (pipelines[id]?.edges.length ?? 1) - 1;
	if (to.kind === 'flow' && from.kind !== 'variable' && from.pipeline !== to.pipeline)
		return { pipeline: to.pipeline, edge: 0, field: null, target: from.pipeline, sources: true };
	const [source, target] = [pipelines[from.pipeline], pipelines[to.pipeline]];
	if (to.kind === 'variable' && from.kind !== 'variable' && source && source.role !== 'outgoing')
		return { pipeline: from.pipeline, edge: ended(from.pipeline), field: null, target: to.name, sources: false };
	if (from.kind === 'variable' && to.kind !== 'variable' && target?.role === 'outgoing') {
		const read = target.first.find(({ variable }) => variable === from.name);
		// A variable of the same resource is a field of the record by its own name.
		const [local = ''] = from.name.split('.').slice(-1);
		const field = read?.field ?? (local in (target.edges.at(-1)?.fields ?? {}) ? local : null);
		return { pipeline: target.id, edge: ended(target.id), field, target: null, sources: false };
	}
	return null;
}
