/** Drawings of a station's own: what of a drawing is painted, and how an element looks by what it follows. */
import type { MimicBound, MimicDrawing } from '#lib/contract.ts';
import { inLanguage } from '#lib/text/text.svelte.ts';
import { holds, withValues, type Variables } from './live.ts';

export interface Painted {
	/** Whether the inside is painted, and whether the outline is. */
	readonly fill: boolean;
	readonly stroke: boolean;
}

/** What is painted of each element; what it says nothing of is as around it. */
export function paintedOf(elements: MimicDrawing['elements']): Painted[] {
	const found: Painted[] = [];
	for (const { inside, attributes } of elements) {
		const around = (inside === null ? undefined : found[inside]) ?? { fill: true, stroke: false };
		const own = (name: 'fill' | 'stroke'): boolean => (attributes[name] === undefined ? around[name] : attributes[name] !== 'none');
		found.push({ fill: own('fill'), stroke: own('stroke') });
	}
	return found;
}

/** The names in one drawing are its own: another that is shown beside it may have the same. */
export function attributeOf(name: string, value: string, prefix: string): string {
	if (name === 'id') return `${prefix}-${value}`;
	if (name === 'href') return value.replace(/^#/, `#${prefix}-`);
	return value.replace(/^url\(#/, `url(#${prefix}-`);
}

export interface Looks {
	/** `doubt`: it is not known whether it is there. */
	readonly shown: 'yes' | 'no' | 'doubt';
	readonly role: MimicBound['role'];
	/** Null: its own. */
	readonly text: string | null;
}

export function looksOf(bound: MimicBound, variables: Variables, language: string): Looks {
	const there = holds(bound.visible, variables);
	return {
		shown: there === null ? 'doubt' : there ? 'yes' : 'no',
		role: holds(bound.when, variables) === true ? bound.role : null,
		text: Object.keys(bound.text).length === 0 ? null : withValues(inLanguage(bound.text, language), variables)
	};
}
