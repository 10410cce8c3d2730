/** What the page of the first start says: no other page, and above all no watch, has to read it. */
import type { Language } from './languages.ts';
import { language } from './text.svelte.ts';

const en = {
	title: 'First start',
	over: 'This station has an administrator already.',
	become: 'You become the first administrator: you decide who else may do what.',
	make: 'Become the administrator',
	nobody: 'Nobody can sign in yet: this station has no administrator.',
	openLink: 'Open the link that the station showed on its terminal as it started. It works once and for 15 minutes; after that',
	showsNew: 'with the station’s folder shows a new one. If you have loaded this page again, open the link again.'
};

const TEXTS: Readonly<Record<Language, typeof en>> = {
	en,
	sv: {
		title: 'Första starten',
		over: 'Stationen har redan en administratör, så ingen länk skapar en till.',
		become: 'Du blir stationens första administratör, som bestämmer vad andra får göra.',
		make: 'Bli administratör',
		nobody: 'Ingen kan logga in än: stationen har ingen administratör.',
		openLink: 'Öppna länken som stationen visade i sin terminal när den startade. Den fungerar en gång och i 15 minuter; därefter visar',
		showsNew: 'med stationens mapp en ny. Har du laddat om sidan, så öppna länken igen.'
	}
};

/** What it says in the language of the page. */
export function firstStart(): typeof en {
	return TEXTS[language()];
}
