/** An alarm in the language of the watch: what the station tells is read only when something is wrong. */
import type { WatchSnapshot } from '#lib/contract.ts';
import type { Language } from '#lib/text/languages.ts';
import { told, type Catalogue } from '#lib/text/message.ts';
import { readRefusals, say } from '#lib/text/text.svelte.ts';

type Messages = Promise<{ default: Catalogue['texts'] }>;
/** What is told of an alarm: what is wrong, and what to do. */
export type Teller = (alarm: NonNullable<WatchSnapshot['alarm']>) => { readonly text: string; readonly action: string };

const MESSAGES: Readonly<Record<Language, () => Messages>> = {
	// The text that came has conditions as engineers write them.
	en: async () => {
		const [messages, findings] = await Promise.all([import('#lib/text/en/messages.json'), import('#lib/text/en/findings.json')]);
		return { default: { ...messages.default, ...findings.default } };
	},
	sv: async () => {
		const [messages, findings] = await Promise.all([import('#lib/text/sv/messages.json'), import('#lib/text/sv/findings.json')]);
		return { default: { ...messages.default, ...findings.default } };
	}
};

/** What tells an alarm in `language`. */
export async function teller(language: Language): Promise<Teller> {
	const [messages] = await Promise.all([MESSAGES[language](), readRefusals()]);
	const catalogue = { texts: { ...say().messages, ...messages.default }, language };
	return ({ text, message, action, action_message }) => ({
		text: told(message, text, catalogue),
		action: told(action_message, action, catalogue)
	});
}
