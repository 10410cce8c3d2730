/** How acts that are done one after the other are said on the button that does them. */
import { say, type Text } from '#lib/text/text.svelte.ts';
import { capital } from '#lib/wording/capital.ts';
import type { ModeAct } from './mode-acts.ts';

type Texts = Pick<Text, 'locale'> & { readonly restart: Pick<Text['restart'], 'acts'> };

/** `Take control and enter restart mode`: all of it in one sentence, `last` at its end. */
export function sayActs(acts: readonly ModeAct[], last: string | null = null, texts: Texts = say()): string {
	const { words } = texts.restart.acts;
	const first = acts.map((act) => words[act]);
	const all = last === null ? first : [...first, acts.length === 0 ? last : lower(last)];
	return capital(new Intl.ListFormat(texts.locale, { type: 'conjunction' }).format(all));
}

const lower = (text: string): string => text.charAt(0).toLocaleLowerCase() + text.slice(1);
