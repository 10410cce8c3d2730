/** What is waited for, in words: what the model writes of an ability is said with its title, the rest as it is written. */
import type { Ability, Condition } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { valueText, variableName } from '#lib/wording/values.ts';

type Titles = Readonly<Record<string, Pick<Ability, 'title'>>>;

/** `nutrunner.run_nut.executing` or its contrary, as a part of a condition. */
const FLAG = /^(not )?(.+)\.(executing|finished)$/;

/** `waits until Run the nutrunner is executing`; what says nothing of an ability is waited for as it is written. */
export function waitText(condition: string, abilities: Titles, texts: Text['operate']['why']): string {
	const [, not, name = '', flag] = FLAG.exec(condition) ?? [];
	const title = Object.hasOwn(abilities, name) ? abilities[name]?.title : undefined;
	if (title !== undefined && flag === 'executing')
		return not === undefined ? texts.untilExecuting(title) : texts.untilNotExecuting(title);
	if (title !== undefined && not === undefined) return texts.untilFinished(title);
	return texts.waitsFor(condition);
}

/** A condition as a sentence: where one variable decides it, with the values that it should have. */
export function sentenceOf({ text: written, text_message, involved }: Condition, abilities: Titles, texts: Text['operate']['why']): string {
	const text = told(text_message, written);
	const flag = FLAG.exec(text);
	if (flag !== null && Object.hasOwn(abilities, flag[2] ?? '')) return waitText(text, abilities, texts);
	const [only, second] = involved;
	if (only === undefined || second !== undefined || only.wanted.length === 0) return texts.waitsFor(text);
	return texts.untilIs(variableName(only.name, null), only.wanted.map(valueText).join(texts.or));
}
