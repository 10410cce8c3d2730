/** What is drawn of pipelines: their messages, joins, stages and variables, and what passes between them. */
import type { DraftPipeline, DraftPipelines, Finding } from '#lib/contract.ts';
import { shortOf } from './findings.ts';
import type { Box, BoxKind, Lane, Picture, Row, Wire } from './picture.ts';

/** Of so many fields at most a message and a stage show what they are; the others are beside the picture. */
const [MOST_OF_MESSAGE, MOST_OF_STAGE] = [3, 2];

type Shown = Pick<DraftPipelines, 'pipelines' | 'variables' | 'types'>;

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
	findings.filter(({ severity }) => severity === 'error').map(shortOf);

/** The box of a pipeline's message, or of the join that a flow begins with. */
export const headOf = (pipeline: string): string => `m:${pipeline}`;
export const variableBox = (name: string): string => `v:${name}`;
/** The box of a variable with which an outgoing pipeline begins, where that is drawn apart from what writes it. */
export const readBox = (name: string): string => `r:${name}`;
const stageBox = (id: string): string => `s:${id}`;

const VARIABLE = { kind: 'variable', stage: null, troubles: [], rows: [], more: 0, spot: null } as const satisfies Partial<Box>;

/** What a variable is called here: without its resource, which is said above it. */
const shortly = (name: string): string => name.split('.').at(-1) ?? name;

function rowsOf(typed: Readonly<Record<string, string>>, most: number, { types }: Shown): Pick<Box, 'rows' | 'more'> {
	// What has parts of its own says little in one line: it comes last.
	const isWhole = (field: string): boolean => types[typed[field] ?? '']?.kind === 'message';
	const fields = Object.keys(typed).toSorted((a, b) => Number(isWhole(a)) - Number(isWhole(b)));
	// A row that says that there is one more would take the room of that one.
	const shown = fields.length <= most ? fields : fields.slice(0, most - 1);
	return { rows: shown.map((field): Row => ({ field, label: shortly(field) })), more: fields.length - shown.length };
}

/** The picture of pipelines; what variables they read has boxes `called` so. */
export function pictureOf(shown: Shown, ids: readonly string[], called: (name: string) => string = variableBox): Picture {
	const boxes = new Map<string, Box>();
	const wires: Wire[] = [];
	const types = new Map(shown.variables.map(({ name, type }) => [name, type]));

	const variable = (id: string, name: string, pipeline: string, type = types.get(name) ?? ''): string => {
		if (!boxes.has(id)) boxes.set(id, { ...VARIABLE, id, pipeline, name, about: type, type });
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
			type: null,
			...rowsOf(edges[role === 'outgoing' ? last : 0]?.fields ?? {}, MOST_OF_MESSAGE, shown),
			spot: { pipeline: id, edge: role === 'outgoing' ? last : 0 }
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
			type: null,
			...rowsOf(stage.gives, MOST_OF_STAGE, shown),
			spot: { pipeline: id, edge: at + 1 }
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
				if (sent) wire(variable(called(name), name, id), first.id, 0, field, first.troubles);
			continue;
		}
		const tail = way.at(-1) ?? head;
		tails.set(id, tail.id);
		for (const { field, becomes, type } of pipeline.ends) wire(tail.id, variable(variableBox(becomes), becomes, id, type), last, field);
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
				boxes.set(lost, { ...VARIABLE, id: lost, kind: 'topic', pipeline: id, name: written, about: '', troubles, type: null });
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
		.map(({ name, type }) => ({ ...VARIABLE, id: variableBox(name), pipeline: ids[0] ?? '', name, about: type, type }));
}

/**
 * The pipelines of a resource, and those that they are joined with: what comes from devices above what is sent to them. A variable
 * stands in each of both parts.
 */
export function lanesOf(shown: DraftPipelines, { resource }: Pick<DraftPipeline, 'resource'>, isLoose: boolean): Omit<Lane, 'title'>[] {
	const own = Object.values(shown.pipelines).filter((each) => each.resource === resource);
	const related = new Set(own.flatMap(({ id }) => relatedTo(id, shown)));
	const ids = Object.keys(shown.pipelines).filter((id) => related.has(id));
	const [into, out] = [ids.filter((id) => shown.pipelines[id]?.role !== 'outgoing'), ids.filter((id) => shown.pipelines[id]?.role === 'outgoing')];
	const heard = pictureOf(shown, into);
	const there = new Set(heard.boxes.map(({ id }) => id));
	const loose = isLoose ? unfed(shown, own.map(({ id }) => id)).filter(({ id }) => !there.has(id)) : [];
	return [
		{ id: 'into', ...heard, boxes: [...heard.boxes, ...loose], pipelines: into },
		{ id: 'out', ...pictureOf(shown, out, readBox), pipelines: out }
	].filter(({ boxes }) => boxes.length > 0);
}
