/** A sign for each kind of thing on the map, beside its name in words for who does not see it. */
import type { Kind } from './bands.ts';

export const SIGNS: Readonly<Record<Kind, string>> = {
	work_master: '≡',
	sequence: '⇉',
	operation: '◎',
	specification: '⊘',
	station: '⌂',
	ability: '▶',
	alarm: '△',
	estimated: '≈',
	output: '⇤',
	measured: '⇥',
	variable: '?',
	flow: '⑂',
	topic: '/',
	service: '?!',
	action: '»',
	predicate: '⊨',
	relation: '~',
	map: '↦',
	set: '∈',
	enumeration: '{}',
	message: '✉'
};
