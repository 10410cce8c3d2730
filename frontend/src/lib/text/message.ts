/** What is said of a station in the language of the page, made of the messages with which the controller tells it. */
import type { Alarm, Argument, Item, Message } from '#lib/contract.ts';
import { language, say } from '#lib/text/text.svelte.ts';
import { capital, withinSentence } from '#lib/wording/capital.ts';
import { titledAlone } from '#lib/wording/titled.svelte.ts';

/**
 * `{name}`, `{name|waits|wait}` for what is said of one and of several, `{name^}` where a sentence begins with it, or `{name~}` for
 * titles that stand within one: “Inget hörs från mutterdragaren”, whose title is “Mutterdragaren”. `{name~^}` is a list that begins one.
 */
const PLACE = /\{(\w+)(?:\|([^|}]*)\|([^|}]*))?(~)?(\^)?\}/g;
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
	return toldHere(message, catalogue) ?? written;
}

/** What a message says in the language of the page; null where there is none, or the page does not know it. */
export function toldHere(message: Message | null | undefined, catalogue = ofPage()): string | null {
	return message ? tell(message, catalogue) : null;
}

/** What is said where a list was cut, around the words for the `others`, and all of it with none left out. */
export interface Cut {
	readonly before: string;
	readonly others: string;
	readonly after: string;
	readonly whole: string;
}

/** Of a list that was cut; what was left out is not in its words. */
const MORE = 'found.more';

/** A text that counts names in place of telling them (`and 65 more`), where the message has them; null of all others. */
export function cutOf(message: Message | null | undefined, catalogue = ofPage()): Cut | null {
	const list = message ? cutIn(message) : null;
	const said = toldHere(message, catalogue);
	if (list === null || said === null) return null;
	const rest = list.arguments?.['rest'];
	const others = tell({ id: MORE, arguments: { ...list.arguments, names: '' } }, catalogue) ?? '';
	const at = others === '' ? -1 : said.indexOf(others);
	if (at < 0 || !Array.isArray(rest)) return null;
	const [before, after] = [said.slice(0, at), said.slice(at + others.length)];
	return { before, others, after, whole: [before, ...rest.map((each) => worded(each, catalogue) ?? '')].join(', ') + after };
}

function cutIn({ id, arguments: given }: Message): Message | null {
	if (id === MORE) return { id, arguments: given ?? {} };
	for (const each of Object.values(given ?? {})) {
		const found = typeof each === 'object' && 'id' in each ? cutIn(each) : null;
		if (found !== null) return found;
	}
	return null;
}

/** What is said first, which leads, and all that is said after it. */
export function leading(text: string): readonly [lead: string, rest: string] {
	const [lead = text] = text.split(/(?<=[.!?])\s(?=\p{Lu})/u);
	return [lead.replace(/\.$/, ''), text.slice(lead.length).trim()];
}

/** The same of several; what reads the same, as of things with the same title, is told once. */
export function toldAll(messages: readonly Message[] | undefined, written: readonly string[], catalogue = ofPage()): readonly string[] {
	return [...new Set(written.map((each, index) => told(messages?.[index], each, catalogue)))];
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
	const said = text.replace(PLACE, (_, name: string, one?: string, several?: string, within?: string, begins?: string) => {
		const argument = given?.[name];
		// A text of another version: the page knows its places and not what stands in them.
		if (argument === undefined) {
			whole = false;
			return '';
		}
		if (one !== undefined && several !== undefined) return isOne(argument) ? one : several;
		const word = worded(argument, catalogue, within !== undefined);
		whole &&= word !== null;
		return begins && word ? capital(word) : (word ?? '');
	});
	return whole ? said : null;
}

function isOne(argument: Argument): boolean {
	return argument === 1 || (Array.isArray(argument) && argument.length === 1);
}

function worded(argument: Argument, catalogue: Catalogue, within = false): string | null {
	if (Array.isArray(argument)) return listed(argument, catalogue, within);
	const word = wordedAlone(argument, catalogue);
	return within && word !== null ? withinSentence(word) : word;
}

function wordedAlone(argument: Item, catalogue: Catalogue): string | null {
	if (typeof argument === 'string') return recorded(argument);
	// `4.9`, in Swedish `4,9`.
	if (typeof argument === 'number') return new Intl.NumberFormat(catalogue.language, { useGrouping: false, maximumFractionDigits: 12 }).format(argument);
	if ('words' in argument) return argument.words[catalogue.language] ?? argument.words['en'] ?? Object.values(argument.words)[0] ?? '';
	return tell(argument, catalogue);
}

/** Titles in what was recorded are in English alone; several stand in one text there. */
function recorded(text: string): string {
	const alone = titledAlone(text);
	return alone === text && text.includes(', ') ? text.split(', ').map(titledAlone).join(', ') : alone;
}

function listed(every: readonly Item[], catalogue: Catalogue, within: boolean): string | null {
	let words = every.map((each) => worded(each, catalogue, within));
	if (words.includes(null)) return null;
	if (words.length > NAMED + 1)
		words = [...words.slice(0, NAMED), tell({ id: 'list.more', arguments: { count: words.length - NAMED } }, catalogue)];
	if (words.length < 2) return words[0] ?? '';
	return tell({ id: 'list.and', arguments: { most: words.slice(0, -1).join(', '), last: words.at(-1) ?? '' } }, catalogue);
}
