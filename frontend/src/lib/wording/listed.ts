/** Names in a sentence. */
import { say } from '#lib/text/text.svelte.ts';

/** So many are named; of more it is said how many others there are. */
const NAMED = 3;

/** `A, B and C`, or `A, B and 6 more`. */
export function listed(names: readonly string[]): string {
	const { locale, common } = say();
	const said = names.length > NAMED ? [...names.slice(0, NAMED - 1), common.more(names.length - NAMED + 1)] : names;
	return new Intl.ListFormat(locale, { type: 'conjunction' }).format(said);
}
