/** What is drawn of pipelines: their messages, joins, stages and variables, and what passes between them. */
import type { DraftPipeline, DraftPipelines, Finding } from '#lib/contract.ts';
import { shortOf } from './findings.ts';
import type { Box, BoxKind, Picture, Wire } from './picture.ts';

type Shown = Pick<DraftPipelines, 'pipelines' | 'variables'>;

/** The pipelines that feed `id`, the ones that it feeds, and itself, in the order of the document. */
export function relatedTo(id: string, { pipelines }: Pick<DraftPipelines, 'pipelines'>): string[] {
	const found = new Set<string>();
	const follow = (from: string, next: (pipeline: DraftPipeline) => readonly (string | null)[]): void => {
		const ways = [from];
		for (let at = ways.pop(); at !== undefined; at = ways.pop()) {
			const pipeline = pipelines[at];
			if (!pipeline) continue;
			found.add(at);
			ways.push(...next(pipeline).filter((each): each is string => each !== null && !found.has(each)));
		}
	};
	follow(id, ({ sources }) => sources.map((source) => source.pipeline));
	found.delete(id);
	follow(id, ({ readers }) => readers);
	return Object.keys(pipelines).filter((each) => found.has(each));
}

const KINDS: Readonly<Record<DraftPipeline['part'], BoxKind>> = {
	topic: 'topic',
	flow: 'flow',
	request: 'service',
	response: 'service',
	goal: 'action',
	feedback: 'action',
	result: 'action',
	status: 'action'
};

const errors = (findings: readonly Finding[]): string[] =>
	findings.filter(({ severity }) => severity === 'error').map(({ message }) => shortOf(message));

/** The box of a pipeline's message, or of the join that a flow begins with. */
export const headOf = (pipeline: string): string => `m:${pipeline}`;
export const variableBox = (name: string): string => `v:${name}`;
const stageBox = (id: string): string => `s:${id}`;

export function pictureOf(shown: Shown, ids: readonly string[]): Picture {
	const boxes = new Map<string, Box>();
	const wires: Wire[] = [];
	const types = new Map(shown.variables.map(({ name, type }) => [name, type]));

	const variable = (name: string, pipeline: string, type = types.get(name) ?? ''): string => {
		const id = variableBox(name);
		if (!boxes.has(id))
			boxes.set(id, { id, kind: 'variable', pipeline, stage: null, name, about: type, troubles: [], type });
		return id;
	};
	/** The boxes that the records of a pipeline go through, and those of its last stage or message. */
	const tails = new Map<string, string>();

	for (const id of ids) {
		const pipeline = shown.pipelines[id];
		if (!pipeline) continue;
		const { edges, stages, role } = pipeline;
		const last = edges.length - 1;
		const head: Box = {
			id: headOf(id),
			kind: KINDS[pipeline.part],
			pipeline: id,
			stage: null,
			name: pipeline.name,
			about: pipeline.message ?? '',
			troubles: errors(pipeline.findings),
			type: null
		};
		const wire = (from: string, to: string, edge: number, field: string | null, troubles: readonly string[] = []): void => {
			const { id: name, fields } = edges[edge] ?? { id: `${id}#${edge}`, fields: null };
			wires.push({
				id: `${name}|${from}|${to}`,
				from,
				to,
				spot: { pipeline: id, edge },
				field,
				fields: fields ?? {},
				troubles
			});
		};
		if (role !== 'outgoing') boxes.set(head.id, head);
		const chain = stages.map((stage, at): Box => ({
			id: stageBox(stage.id),
			kind: 'stage',
			pipeline: id,
			stage: at,
			name: stage.kind,
			about: stage.summary,
			troubles: errors(stage.findings),
			type: null
		}));
		for (const box of chain) boxes.set(box.id, box);
		if (role === 'outgoing') boxes.set(head.id, head);

		const way = role === 'outgoing' ? [...chain, head] : [head, ...chain];
		// Edge n of an outgoing pipeline leads to box n, of another one it comes from box n.
		way.slice(0, -1).forEach((box, at) => {
			const to = way[at + 1];
			if (to) wire(box.id, to.id, role === 'outgoing' ? at + 1 : at, null, to.troubles);
		});
		if (role === 'outgoing') {
			const first = way[0] ?? head;
			for (const { field, variable: name, sent } of pipeline.first)
				if (sent) wire(variable(name, id), first.id, 0, field, first.troubles);
			continue;
		}
		const tail = way.at(-1) ?? head;
		tails.set(id, tail.id);
		for (const { field, becomes, type } of pipeline.ends) wire(tail.id, variable(becomes, id, type), last, field);
		for (const { pipeline: source, troubles, written, place } of pipeline.sources.map((each) => ({
			...each,
			troubles: errors(each.findings)
		}))) {
			const from = source === null ? undefined : tails.get(source);
			if (from !== undefined && source !== null) {
				const end = shown.pipelines[source]?.edges.at(-1);
				wires.push({
					id: `${end?.id ?? source}|${from}|${head.id}|${place.path.at(-1)}`,
					from,
					to: head.id,
					spot: { pipeline: source, edge: (shown.pipelines[source]?.edges.length ?? 1) - 1 },
					field: null,
					fields: end?.fields ?? {},
					troubles
				});
			} else {
				const lost = `x:${id}:${written}`;
				boxes.set(lost, { id: lost, kind: 'topic', pipeline: id, stage: null, name: written, about: '', troubles, type: null });
				wires.push({ id: lost, from: lost, to: head.id, spot: null, field: null, fields: {}, troubles });
			}
		}
	}
	return { boxes: [...boxes.values()], wires };
}

/** The measured variables of the resources of these pipelines that nothing writes. */
export function unfed({ pipelines, variables }: Shown, ids: readonly string[]): Box[] {
	const resources = new Set(ids.flatMap((id) => (pipelines[id]?.role === 'outgoing' ? [] : [pipelines[id]?.resource])));
	return variables
		.filter(({ kind, fed, resource }) => kind === 'measured' && fed === null && resources.has(resource))
		.map(({ name, type }) => ({
			id: variableBox(name),
			kind: 'variable',
			pipeline: ids[0] ?? '',
			stage: null,
			name,
			about: type,
			troubles: [],
			type
		}));
}
