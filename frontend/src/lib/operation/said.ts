/** What is said of an operation that is not done. */
import type { Operation, StationView } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { durationText } from '#lib/wording/time.ts';
import type { Asked } from './asked.ts';
import { isAtWork, type OperationStanding } from './standing.ts';

type Texts = Text['operate']['operations'];

/** Until when an active one is under way and for how long it has been worked on, or what another waits for; `asked` is what jobs have to do with it. */
export function saidOf(operation: Operation, standing: OperationStanding, now: number, mode: StationView['mode'], texts: Texts, asked: Asked | null = null): string {
	const { active, active_since, goal, precondition, sentence, work } = operation;
	const what = sentence ? told(sentence, active ? goal : precondition) : '';
	if (!active && asked?.how === 'none') return texts.noOrder;
	if (!active && asked?.how === 'paused') return texts.orderPaused;
	if (!active) return what !== '' ? what : asked?.how === 'later' ? texts.laterInOrder : texts.soAlready;
	if (standing === 'waits') return mode === 'automatic' ? texts.startFirst : texts.modeFirst;
	// Since when it stands is said above the plan.
	const since = isAtWork(operation) ? work.at(-1)?.began : null;
	const parts = standing === 'stopped' ? [texts.stopped, what] : [what, durationText(now - (since ?? active_since ?? now))];
	return parts.filter((part) => part !== '').join(' · ');
}

/**
 * What is said of several that wait, each for its own: what differs in one place is told as what may come first, as in *waits until
 * bolt pair 1, 2 or 3 is placed*; of what differs more the first.
 */
export function eitherOf(sentences: readonly string[], locale: string): string {
	const different = [...new Set(sentences)];
	const [first = '', ...rest] = different;
	const words = different.map((each) => each.split(' '));
	if (rest.length === 0 || words.some(({ length }) => length !== words[0]?.length)) return first;
	const places = (words[0] ?? []).flatMap((word, at) => (words.every((of) => of[at] === word) ? [] : [at]));
	const [place, ...others] = places;
	if (place === undefined || others.length > 0) return first;
	const either = new Intl.ListFormat(locale, { type: 'disjunction' }).format(words.map((of) => of[place] ?? ''));
	return (words[0] ?? []).map((word, at) => (at === place ? either : word)).join(' ');
}
