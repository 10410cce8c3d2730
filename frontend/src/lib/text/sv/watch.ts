import type { Text } from '../text.svelte.ts';

export const watch: Text['watch'] = {
	forYou: 'För dig',
	nothingToDo: 'Inget att göra',
	nothingWhenHeard: 'Inget när den senast hördes',
	nothingKnown: 'Inget är känt om dina uppgifter',
	operatorSays: 'En operatör säger till när det är klart.',
	done: 'Klart',
	record: 'Notera som klart',
	sent: 'Skickat',
	gone: 'Uppgiften finns inte längre.',
	movesNext: 'Rör sig sedan:',
	moreAfter: (n) => `${n} till efter denna`,
	waits: (duration) => `väntar ${duration}`,
	nothingMoves: 'Inget rör sig än. Klart antecknas.',
	standing: {
		preparing: 'Förbereder',
		waiting: 'Produktionen är inte startad',
		held: 'Stopp: håll avstånd',
		restart: 'Omstart: håll avstånd',
		paused: 'Pausad',
		stopped: 'Står stilla: hjälp behövs'
	},
	silent: (titles) => `Ingen kontakt: ${titles}`,
	failing: (titles) => `Behöver hjälp: ${titles}`,
	problem: 'Problem',
	wrong: 'Vad är fel?',
	wrongs: { missing: 'Del saknas', damaged: 'Skadad', tool: 'Verktyg', other: 'Annat' },
	back: 'Tillbaka',
	solved: 'Löst',
	told: 'Stationen vet om det.',
	problemOf: (name) => `${name} har problem med den`,
	notLive: 'Inte direkt',
	causes: {
		connecting: 'Ansluter till stationen.',
		closed: 'Anslutningen till servern är bruten. Försöker igen.',
		controller: 'Servern hör inte styrningen.',
		gap: 'Ett meddelande gick förlorat.',
		silent: 'Inget nytt har kommit från servern.'
	},
	soundOn: 'Ljud på',
	soundOff: 'Ljud av',
	signIn: 'Logga in',
	pairing: {
		title: 'Para ihop klockan',
		code: (digits) => `Kod med ${digits} siffror`,
		pair: 'Para ihop',
		where: 'Koden står på sidan Enheter.',
		waiting: 'Väntar',
		confirmBefore: 'Bekräfta',
		confirmAfter: 'på stationens sida.',
		ended: 'Återkallad eller utgången',
		endedWhy: (name) => `Enheten är inte längre klockan ${name}. Para ihop den igen.`,
		unconfirmed: 'Inte bekräftad',
		unconfirmedWhy: (name) => `${name} nekades, eller så gick två minuter. Be om en ny kod.`
	}
};
