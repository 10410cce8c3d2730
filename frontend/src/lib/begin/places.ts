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

/** All that is wrong with a sketch: as the server says, and what cannot be sent at all. */
export function wrongIn(problems: readonly OutlineProblem[], sketch: Sketch, words: { readonly notNumbers: string }): Wrong[] {
	const here = notNumbers(sketch).map((key): Wrong => ({ key, step: 'poses', why: words.notNumbers }));
	const known = new Set(here.map(({ key }) => key));
	const there = problems.map(
		({ place, why, why_message: message }): Wrong => ({ key: keyAt(place, sketch), step: stepOf(place), why: told(message, why) })
	);
	return [...there.filter(({ key }) => !known.has(key)), ...here];
}

function notNumbers({ devices }: Sketch): Key[] {
	return devices.flatMap(({ poses }) => poses.filter(({ joints }) => readNumbers(joints) === null).map(({ id }) => keyOf(id, 'joints')));
}
