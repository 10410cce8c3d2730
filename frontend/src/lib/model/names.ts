/** Which names parts of a model may have. */
import type { Text } from '#lib/text/text.svelte.ts';
import type { EntryKind } from './tree.ts';

/** Why a name cannot be given, in the catalogue. */
export type BadName = keyof Text['model']['badName'];

const WORDS = new Set(['and', 'or', 'not', 'implies', 'in', 'if', 'true', 'false']);
const ROS: ReadonlySet<EntryKind> = new Set<EntryKind>(['topic', 'service', 'action']);

/** What is wrong with `name` for something of that kind among those that are called `taken`; null when it can be used. */
export function badName(kind: EntryKind, name: string, taken: Iterable<string>): BadName | null {
	if (name.trim() === '') return 'empty';
	if (name !== name.trim()) return 'blank';
	if (name.length > 100) return 'long';
	if (kind === 'message') {
		if (!/^[a-z][a-z0-9_]*\/(msg|srv|action)\/[A-Z][A-Za-z0-9]*$/.test(name)) return 'message';
	} else if (ROS.has(kind)) {
		if (!/^\/?[A-Za-z_~][A-Za-z0-9_]*(\/[A-Za-z_][A-Za-z0-9_]*)*$/.test(name)) return 'ros';
	} else if (/^[0-9]/.test(name)) return 'digit';
	else if (!/^[A-Za-z_][A-Za-z0-9_]*$/.test(name)) return 'sign';
	else if (WORDS.has(name)) return 'word';
	else if (kind === 'resource' && name === 'operation') return 'operation';
	for (const each of taken) if (each === name) return 'taken';
	return null;
}
