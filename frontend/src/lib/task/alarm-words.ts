/** The name of an alarm in the language of the watch: what the station tells is read only when something is wrong. */
import type { WatchSnapshot } from '#lib/contract.ts';
import type { Language } from '#lib/text/languages.ts';
import { told, type Catalogue } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';

type Messages = Promise<{ default: Catalogue['texts'] }>;

const MESSAGES: Readonly<Record<Exclude<Language, 'en'>, () => Messages>> = { sv: () => import('#lib/text/sv/messages.json') };

/** What tells an alarm in `language`. It says itself in English what it says. */
export async function teller(language: Language): Promise<(alarm: NonNullable<WatchSnapshot['alarm']>) => string> {
	const messages = language === 'en' ? {} : (await MESSAGES[language]()).default;
	const catalogue = { texts: { ...say().messages, ...messages }, language };
	return ({ text, message }) => told(message, text, catalogue);
}
