/**
 * What is written on the page: an outline in which all parts are told apart by numbers. Names are what a person writes:
 * they may be missing, or be there twice, and what is said of a part stays said of it when its name becomes another one.
 */
import type { Outline } from '#lib/contract.ts';
import { numbersText, readNumbers } from './numbers.ts';

/** As many as an outline can have, of each; and letters of a name and of a title. */
export const MOST = { devices: 40, poses: 60, states: 40, stands: 10, facts: 10, never: 40, topics: 50, name: 100, title: 200 } as const;

export interface Called {
	readonly id: number;
	title: string;
	name: string;
}

export interface PoseSketch extends Called {
	/** Numbers, as they are written. */
	joints: string;
}

export const KINDS = ['robot', 'tool', 'clamp', 'person', 'found'] as const;
export type DeviceKind = (typeof KINDS)[number];
/** Those of the library, which need nothing but a name. */
export type LibraryKind = Exclude<DeviceKind, 'found'>;

export interface DeviceSketch extends Called {
	readonly kind: DeviceKind;
	/** Of a robot. */
	poses: PoseSketch[];
	ways: 'any' | 'row';
	/** Of a device that was found on the network. */
	topics: string[];
}

export interface StandSketch {
	readonly id: number;
	robot: number | null;
	pose: number | null;
}

export interface StepSketch extends Called {
	by: number | null;
	action: 'open' | 'close' | null;
	where: StandSketch[];
}

export type Then = Outline['product']['then'];
export const THEN = ['next', 'order', 'once'] as const satisfies readonly Then[];

export interface ProductSketch extends Called {
	states: Called[];
	/** What leads from each state to the next: one fewer. */
	steps: StepSketch[];
	then: Then;
}

/** A part by its number, in one of its values: a pose or a state by its number, or one that all of its kind have. */
export interface FactSketch {
	readonly id: number;
	thing: number | null;
	value: number | string | null;
	holds: boolean;
}

export interface NeverSketch {
	readonly id: number;
	title: string;
	facts: FactSketch[];
	during: FactSketch[];
}

export interface Sketch {
	/** The number that was given last. */
	last: number;
	/** The template that it began with. */
	template: string | null;
	title: string;
	devices: DeviceSketch[];
	product: ProductSketch;
	never: NeverSketch[];
}

export function blank(): Sketch {
	return { last: 1, template: null, title: '', devices: [], product: { id: 1, title: '', name: '', states: [], steps: [], then: 'next' }, never: [] };
}

/** A number that no other part has. */
export function numbered(sketch: Pick<Sketch, 'last'>): number {
	sketch.last += 1;
	return sketch.last;
}

/** The outline as the server takes it. `said`: what a *Never* without a title is called. */
export function outlineOf(sketch: Sketch, said: (never: NeverSketch) => string = () => ''): Outline {
	const names = new Map<number | string | null, string>();
	const all = [...sketch.devices, ...sketch.devices.flatMap(({ poses }) => poses), sketch.product, ...sketch.product.states];
	for (const { id, name } of all) names.set(id, name);
	for (const step of sketch.product.steps) names.set(step.id, `step:${names.get(step.by) ?? ''}.${step.name}`);
	const nameOf = (of: number | string | null): string => (typeof of === 'string' ? of : (names.get(of) ?? ''));
	const fact = ({ thing, value, holds }: FactSketch): Outline['never'][number]['facts'][number] => ({ thing: nameOf(thing), value: nameOf(value), holds });
	return {
		title: sketch.title,
		devices: sketch.devices.map((device) => deviceOutline(device)),
		product: {
			...called(sketch.product),
			states: sketch.product.states.map(called),
			steps: sketch.product.steps.map((step) => ({
				...called(step),
				by: nameOf(step.by),
				action: sketch.devices.find(({ id }) => id === step.by)?.kind === 'clamp' ? step.action : null,
				where: step.where.map(({ robot, pose }) => ({ robot: nameOf(robot), pose: nameOf(pose) }))
			})),
			then: sketch.product.then
		},
		never: sketch.never.map((never) => ({ title: never.title || said(never), facts: never.facts.map(fact), during: never.during.map(fact) }))
	};
}

const called = ({ name, title }: Called): { name: string; title: string } => ({ name, title });

function deviceOutline(device: DeviceSketch): Outline['devices'][number] {
	const { kind } = device;
	switch (kind) {
		case 'robot': {
			const poses = device.poses.map((pose) => ({ ...called(pose), joints: readNumbers(pose.joints) ?? [] }));
			return { ...called(device), kind, poses, ways: device.ways };
		}
		case 'found':
			return { ...called(device), kind, topics: [...device.topics] };
		default:
			return { ...called(device), kind };
	}
}

/** What is written on the page of an outline, to be gone on with. */
export function sketchOf(outline: Outline, template: string | null = null): Sketch {
	const sketch: Sketch = { ...blank(), template, title: outline.title };
	const call = ({ name, title }: { readonly name: string; readonly title: string }): Called => ({ id: numbered(sketch), title, name });
	const found = (parts: readonly Called[], name: string): number | null => parts.find((each) => each.name === name)?.id ?? null;
	sketch.devices = outline.devices.map((device) => ({
		...call(device),
		kind: device.kind,
		poses: device.kind === 'robot' ? device.poses.map((pose) => ({ ...call(pose), joints: numbersText(pose.joints) })) : [],
		ways: device.kind === 'robot' ? device.ways : 'any',
		topics: device.kind === 'found' ? [...device.topics] : []
	}));
	const { product } = outline;
	sketch.product = {
		id: sketch.product.id,
		title: product.title,
		name: product.name,
		states: product.states.map(call),
		steps: product.steps.map((step) => ({
			...call(step),
			by: found(sketch.devices, step.by),
			action: step.action ?? null,
			where: step.where.map(({ robot, pose }) => ({
				id: numbered(sketch),
				robot: found(sketch.devices, robot),
				pose: found(sketch.devices.find((each) => each.name === robot)?.poses ?? [], pose)
			}))
		})),
		then: product.then
	};
	const steps = new Map(product.steps.map((step, at) => [`step:${step.by}.${step.name}`, sketch.product.steps[at]?.id ?? null]));
	const fact = ({ thing, value, holds }: Outline['never'][number]['facts'][number]): FactSketch => {
		const device = sketch.devices.find((each) => each.name === thing);
		const of = device?.id ?? steps.get(thing) ?? found([sketch.product], thing);
		const values = of === sketch.product.id ? sketch.product.states : device?.kind === 'robot' ? device.poses : null;
		return { id: numbered(sketch), thing: of, value: values ? found(values, value) : value, holds };
	};
	sketch.never = outline.never.map(({ title, facts, during }) => ({ id: numbered(sketch), title, facts: facts.map(fact), during: during.map(fact) }));
	return sketch;
}

/** Whether something was written beside the title, that is more than the template it began with. */
export function isWritten(sketch: Sketch, templates: Readonly<Record<string, Outline>>): boolean {
	const told = (of: Sketch): string => JSON.stringify({ ...outlineOf(of), title: '' });
	const template = sketch.template === null ? undefined : templates[sketch.template];
	return told(sketch) !== told(template === undefined ? blank() : sketchOf(template));
}

/** What was kept of a sketch, read again; null where it is none. */
export function readSketch(text: string | null): Sketch | null {
	if (text === null) return null;
	try {
		const read = JSON.parse(text) as Sketch;
		const isWhole = Number.isSafeInteger(read.last) && typeof read.title === 'string' && Array.isArray(read.product.states);
		if (!isWhole) return null;
		JSON.stringify(outlineOf(read)); // what lacks something else does not get that far
		return read;
	} catch {
		return null;
	}
}
