/** What a *Never* can be about: devices, the product and its steps, each with what it can be. */
import type { Text } from '#lib/text/text.svelte.ts';
import type { Called, FactSketch, Sketch, StepSketch } from './sketch.ts';

export type ThingKind = 'robot' | 'tool' | 'clamp' | 'person' | 'product' | 'step';

export interface Thing {
	readonly id: number;
	readonly kind: ThingKind;
	readonly title: string;
	readonly values: readonly { readonly value: number | string; readonly title: string }[];
}

/** What all of a kind can be, as the documents have it. */
export const VALUES = { tool: ['running', 'idle'], clamp: ['open', 'closed'], person: ['busy', 'free'], step: ['under_way'] } as const;
export type ValueWord = (typeof VALUES)[keyof typeof VALUES][number];

/** What people read of a part. */
export function titled({ title, name }: Pick<Called, 'title' | 'name'>): string {
	return title.trim() || name.replaceAll('_', ' ').trim();
}

export function thingsOf({ devices, product }: Sketch, words: Text['begin']['values']): Thing[] {
	const parts = (of: readonly Called[]): Thing['values'] => of.map((each) => ({ value: each.id, title: titled(each) }));
	const fixed = (kind: keyof typeof VALUES): Thing['values'] => VALUES[kind].map((value) => ({ value, title: words[value] }));
	const found: Thing[] = [];
	for (const device of devices) {
		const { id, kind } = device;
		if (kind === 'found') continue;
		found.push({ id, kind, title: titled(device), values: kind === 'robot' ? parts(device.poses) : fixed(kind) });
	}
	if (product.states.length > 0) found.push({ id: product.id, kind: 'product', title: titled(product), values: parts(product.states) });
	for (const step of product.steps) found.push({ id: step.id, kind: 'step', title: titled(step), values: fixed('step') });
	return found.filter(({ title }) => title !== '');
}

/** A fact in words: `Robot in the pose “at the bolt”`, or `Operator is busy` where it is what holds meanwhile. */
export function factText(fact: FactSketch, things: readonly Thing[], words: Text['begin'], meanwhile: boolean): string {
	const thing = things.find(({ id }) => id === fact.thing);
	if (thing === undefined) return words.blank;
	const value = thing.values.find((each) => each.value === fact.value)?.title ?? words.blank;
	const say = meanwhile ? words.sentence.during : words.sentence.fact;
	const said = thing.kind === 'robot' ? words.sentence.inPose(value) : value;
	return say(thing.title, said, fact.holds);
}

/** What the operation of a step is called in the documents: as the step, and by its device too where another step is called so. */
export function operationOf(step: Pick<StepSketch, 'name' | 'by'>, { devices, product }: Pick<Sketch, 'devices' | 'product'>): string {
	const isTwice = product.steps.filter(({ name }) => name === step.name).length > 1;
	const by = devices.find(({ id }) => id === step.by)?.name ?? '';
	return isTwice && by !== '' && step.name !== '' ? `${step.name}_by_${by}` : step.name;
}
