/** What of the draft becomes another text when an outline is put into it. */
import type { Edit } from '#lib/contract.ts';
import { entriesOf, type Json } from '#lib/model/content.ts';
import { STATION } from '#lib/model/tree.ts';

type Texts = Readonly<Record<string, { readonly text: string }>>;

/** What devices say is defined there, and may be used by others too: these stay. */
const DEFINITION = /\.(?:msg|srv|action)$/;

/** The paths of the draft that are no more afterwards. */
export function removedBy(made: Readonly<Record<string, string>>, present: Texts): string[] {
	return Object.keys(present).filter((file) => !Object.hasOwn(made, file) && !DEFINITION.test(file)).toSorted();
}

/** One change, that makes the draft of what was `made`. */
export function editsOf(made: Readonly<Record<string, string>>, present: Texts): Edit[] {
	const text = (file: string): string | null => present[file]?.text ?? null;
	const written = Object.entries(made).filter(([file, now]) => text(file) !== now);
	return [
		...written.map(([file, now]): Edit => ({ kind: 'text', file, was: text(file), text: now })),
		...removedBy(made, present).map((file): Edit => ({ kind: 'text', file, was: text(file), text: null }))
	];
}

/** Whether a draft holds nothing but the station's name. */
export function isEmpty(files: Texts, contents: Readonly<Record<string, Json | undefined>>): boolean {
	if (Object.keys(files).some((file) => file !== STATION)) return false;
	return entriesOf(contents[STATION]).every(([key]) => key === 'name');
}
