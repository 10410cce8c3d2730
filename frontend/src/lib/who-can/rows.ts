/** What is said of who can do what: of operations that are active, and of those that come later. */
import { isOver } from '#lib/alarm/priority.ts';
import type { Alarm, WhoCan } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { listed } from '#lib/wording/listed.ts';
import { inSentence, nameOf, valueOf } from '#lib/wording/names.svelte.ts';
import type { Row } from './who-can-rows.svelte';

export interface Rows {
	readonly now: readonly Row[];
	readonly later: readonly Row[];
}

/**
 * What takes no part, of which a page says nothing else: it has a list of what is out of service, and beside it stands the
 * alarm `first`.
 */
export function absentUntold({ absent }: WhoCan, first: Alarm | undefined): WhoCan['absent'] {
	const told = first && !isOver(first) ? first.resources : [];
	return absent.filter(({ of, name, why }) => why !== 'out of service' && !(of === 'resource' && told.includes(name)));
}

type Told = WhoCan['nobody'][number] | WhoCan['others'][number];

function split<T extends Told>(every: readonly T[], said: (each: T) => string): Rows {
	const rows = (active: boolean): Row[] =>
		every
			.filter((each) => each.active === active)
			.map((each) => ({ operation: each.operation, title: each.title, said: said(each) }));
	return { now: rows(true), later: rows(false) };
}

export const whoCanText = {
	/** What each lacks that nobody can do. */
	nobody: ({ nobody }: WhoCan): Rows => split(nobody, ({ lacks }) => say().operate.whoCan.lacks(listed(lacks))),

	/** By whom the others can be done, and what has to be so first. */
	others: ({ others }: WhoCan): Rows =>
		split(others, ({ by, once, once_message }) => {
			const texts = say().operate.whoCan;
			const first = Object.entries(once).map(([name, value]) => `${inSentence(nameOf(name, null))}: ${valueOf(name, value)}`);
			const whom = by.length > 0 ? texts.by(by.join(', ')) : first.length > 0 ? '' : texts.goesOn;
			return [whom, first.length > 0 ? texts.once(told(once_message, first.join(', '))) : ''].filter((each) => each !== '').join(', ');
		})
};
