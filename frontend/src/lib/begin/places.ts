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

/** What cannot be sent at all: joints that are no numbers. */
export function unsendable({ devices }: Sketch, words: { readonly notNumbers: string }): Wrong[] {
	const poses = devices.flatMap((device) => device.poses).filter(({ joints }) => readNumbers(joints) === null);
	return poses.map(({ id }) => ({ key: keyOf(id, 'joints'), step: 'poses', why: words.notNumbers }));
}
