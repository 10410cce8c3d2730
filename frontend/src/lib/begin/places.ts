/** Where on the page something of the outline is written, and what is wrong there. */
import type { OutlineProblem } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { readNumbers } from './numbers.ts';
import type { Sketch } from './sketch.ts';
import type { Step } from './steps.ts';

/** The key of a field: the number of the part that it is of, and its name in that. Of the whole the number is left out. */
export type Key = `${number | ''}.${string}`;

export const keyOf = (id: number | null, field: string): Key => `${id ?? ''}.${field}`;

export interface Wrong {
	readonly key: Key;
	readonly step: Step;
	readonly why: string;
}

/** The key of a place in the outline of a sketch: parts have moved by when it is looked for. */
export function keyAt(place: OutlineProblem['place'], sketch: Sketch): Key {
	let value: unknown = sketch;
	let id: number | null = null;
	let rest: (string | number)[] = [];
	for (const step of place) {
		rest.push(step);
		value = typeof value === 'object' && value !== null ? (value as Record<string | number, unknown>)[step] : undefined;
		if (typeof value === 'object' && value !== null && 'id' in value && typeof value.id === 'number') {
			id = value.id;
			rest = [];
		}
	}
	return keyOf(id, rest.join('.'));
}

/** The step in which it is written. */
export function stepOf([of, , within]: OutlineProblem['place']): Step {
	if (of === 'devices') return within === 'poses' || within === 'ways' ? 'poses' : 'devices';
	return of === 'product' || of === 'never' ? of : 'station';
}

/** What the server says is wrong with a sketch. */
export function wrongIn(problems: readonly OutlineProblem[], sketch: Sketch): Wrong[] {
	return problems.map(({ place, why, why_message: message }) => ({ key: keyAt(place, sketch), step: stepOf(place), why: told(message, why) }));
}

/** What the page itself knows better: joints that are no numbers cannot be sent, and what was not chosen yet is not gone. */
export function unsaid({ devices, product, never }: Sketch, words: { readonly notNumbers: string; readonly notChosen: string }): Wrong[] {
	const open = (step: Step, id: number, field: string): Wrong => ({ key: keyOf(id, field), step, why: words.notChosen });
	const poses = devices.flatMap((device) => device.poses).filter(({ joints }) => readNumbers(joints) === null);
	const stands = product.steps.flatMap(({ where }) => where);
	const facts = never.flatMap((each) => [...each.facts, ...each.during]);
	return [
		...poses.map(({ id }): Wrong => ({ key: keyOf(id, 'joints'), step: 'poses', why: words.notNumbers })),
		...stands.flatMap(({ id, robot, pose }) => (robot === null ? [open('product', id, 'robot')] : pose === null ? [open('product', id, 'pose')] : [])),
		...facts.flatMap(({ id, thing, value }) => (thing === null ? [open('never', id, 'thing')] : value === null ? [open('never', id, 'value')] : []))
	];
}
