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

/** As what two boxes are connected already; null where they are not. */
export interface Joined {
	readonly pipeline: string;
	/** The field that passes there; null for whole records. */
	readonly field: string | null;
}

export function joinedBy(from: Box, to: Box, { pipelines }: Pick<DraftPipelines, 'pipelines'>): Joined | null {
	const [source, target] = [pipelines[from.pipeline], pipelines[to.pipeline]];
	if (to.kind === 'flow' && from.kind !== 'variable' && target?.sources.some(({ pipeline }) => pipeline === from.pipeline) === true)
		return { pipeline: to.pipeline, field: null };
	if (to.kind === 'variable' && from.kind !== 'variable' && source && source.role !== 'outgoing') {
		const end = source.ends.find(({ becomes }) => becomes === to.name);
		return end ? { pipeline: from.pipeline, field: end.field } : null;
	}
	if (from.kind === 'variable' && to.kind !== 'variable' && target?.role === 'outgoing') {
		const read = target.first.find(({ variable, sent }) => sent && variable === from.name);
		return read ? { pipeline: target.id, field: read.field } : null;
	}
	return null;
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
