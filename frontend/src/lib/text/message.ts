/** What is said of a station in the language of the page, made of the messages with which the controller tells it. */
import type { Alarm, Argument, Item, Message } from '#lib/contract.ts';
import { language, say } from '#lib/text/text.svelte.ts';
import { titledAlone } from '#lib/wording/titled.svelte.ts';

/** `{name}`, or `{name|waits|wait}` for what is said of one and of several. */
const PLACE = /\{(\w+)(?:\|([^|}]*)\|([^|}]*))?\}/g;
/** Of a list so many are named, and the others counted. */
const NAMED = 3;

export interface Words {
	readonly text: string;
	readonly consequence: string;
	readonly action: string;
	readonly parts: readonly string[];
}

/** The texts by their ids, and the language they are in. */
export interface Catalogue {
	readonly texts: Readonly<Record<string, string>>;
	readonly language: string;
}

const ofPage = (): Catalogue => ({ texts: say().messages, language: language() });

/** What a message says; what was written in English, where there is none or the page does not know it. */
export function told(message: Message | null | undefined, written: string, catalogue = ofPage()): string {
	return (message && tell(message, catalogue)) ?? written;
}

/** What is said first, which leads, and all that is said after it. */
export function leading(text: string): readonly [lead: string, rest: string] {
	const [lead = text] = text.split(/(?<=[.!?])\s(?=\p{Lu})/u);
	return [lead.replace(/\.$/, ''), text.slice(lead.length).trim()];
}

/** The same of several. */
export function toldAll(messages: readonly Message[] | undefined, written: readonly string[], catalogue = ofPage()): readonly string[] {
	return written.map((each, index) => told(messages?.[index], each, catalogue));
}

/** The words of an alarm. A record of before, or of a kind that the page does not know, is told as it was written. */
export function wordsOf(alarm: Pick<Alarm, 'text' | 'consequence' | 'action' | 'parts'> & { messages?: Alarm['messages'] }, catalogue = ofPage()): Words {
	const { messages } = alarm;
	if (messages === undefined) return alarm;
	return {
		text: told(messages.text, alarm.text, catalogue),
		consequence: told(messages.consequence, alarm.consequence, catalogue),
		action: told(messages.action, alarm.action, catalogue),
		parts: toldAll(messages.parts, alarm.parts, catalogue)
	};
}

/** A message in words; null where the catalogue lacks one of its texts, or has one of another version. */
export function tell({ id, arguments: given }: Message, catalogue: Catalogue): string | null {
	const text = catalogue.texts[id];
	if (text === undefined) return null;
	let whole = true;
	const said = text.replace(PLACE, (_, name: string, one?: string, several?: string) => {
		const argument = given?.[name];
		// A text of another version: the page knows its places and not what stands in them.
		if (argument === undefined) {
			whole = false;
			return '';
		}
		if (one !== undefined && several !== undefined) return isOne(argument) ? one : several;
		const word = worded(argument, catalogue);
		whole &&= word !== null;
		return word ?? '';
	});
	return whole ? said : null;
}

function isOne(argument: Argument): boolean {
	return argument === 1 || (Array.isArray(argument) && argument.length === 1);
}

function worded(argument: Argument, catalogue: Catalogue): string | null {
	// A title in what was recorded is in English alone.
	if (typeof argument === 'string') return titledAlone(argument);
	if (typeof argument === 'number') return String(argument);
	if (Array.isArray(argument)) return listed(argument, catalogue);
	if ('words' in argument) return argument.words[catalogue.language] ?? argument.words['en'] ?? Object.values(argument.words)[0] ?? '';
	return tell(argument, catalogue);
}

function listed(every: readonly Item[], catalogue: Catalogue): string | null {
	let words = every.map((each) => worded(each, catalogue));
	if (words.includes(null)) return null;
	if (words.length > NAMED + 1)
		words = [...words.slice(0, NAMED), tell({ id: 'list.more', arguments: { count: words.length - NAMED } }, catalogue)];
	if (words.length < 2) return words[0] ?? '';
	return tell({ id: 'list.and', arguments: { most: words.slice(0, -1).join(', '), last: words.at(-1) ?? '' } }, catalogue);
}
