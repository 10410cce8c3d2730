import type { Text } from '../text.svelte.ts';

export const door: Text['door'] = {
	connecting: 'Ansluter',
	notLive: 'Inte direkt.',
	tryingAgain: 'Försöker igen.',
	toStation: 'Till stationen',
	notFound: {
		title: 'Finns inte',
		noPage: 'Det finns ingen sådan sida',
		failed: 'Sidan kunde inte visas'
	},
	at: (host) => `Stationen på ${host}`,
	or: 'eller',
	signIn: {
		title: 'Logga in',
		under: 'Loggar in',
		missing: 'Både namn och lösenord behövs.',
		help: 'Inget namn än, eller glömt lösenordet? En administratör för stationen kan hjälpa.',
		pair: 'Para ihop en klocka'
	},
	provider: {
		title: (provider) => `Logga in med ${provider}`,
		under: (provider) => `Går till ${provider}`,
		finishing: (provider) => `${provider} har svarat. Loggar in`,
		finishingAny: 'Leverantören har svarat. Loggar in',
		back: 'Tillbaka till inloggningen',
		signOut: (provider) => `Logga ut från ${provider} också`,
		stillThere: (provider) =>
			`Du är utloggad här. Hos ${provider} kan du fortfarande vara inloggad: logga ut även där om andra använder enheten.`
	},
	name: { label: 'Namn', missing: 'Skriv ditt namn.' },
	password: {
		label: 'Lösenord',
		missing: 'Skriv ditt lösenord.',
		show: 'Visa',
		hide: 'Dölj',
		capsLock: 'Caps Lock är på.',
		missingAbove: 'Något saknas ovan.',
		rules: (shortest) =>
			`Minst ${shortest} tecken, vilka som helst; några ord går bra. Det får inte innehålla namnet, och inte vara ett och samma tecken.`,
		short: (length, shortest) => `Lösenordet har ${length} tecken; det behöver minst ${shortest}.`,
		long: (length, longest) => `Lösenordet har ${length} tecken; högst ${longest} ryms.`,
		named: 'Lösenordet innehåller namnet.',
		repeated: 'Lösenordet är ett och samma tecken.'
	},
	demonstration: {
		about: 'Detta är en demonstration med emulerade enheter, som kan användas utan namn.',
		open: 'Öppna demonstrationen'
	},
	first: {
		noAdministrator: 'Stationen har ingen administratör än.',
		how: 'Hur någon blir det',
	},
	refusal: {
		notSent: 'Inte skickat',
		notSentWhy: 'Servern nås inte. Se på stationen innan du försöker igen.',
		noAnswer: 'Inget svar',
		noAnswerWhy: 'Servern svarade inte i tid, och ingen vet om det är gjort. Se på stationen innan du försöker igen.',
		notRead: 'Inte läst',
		notReached: 'Servern nås inte.',
		refused: 'Nekat',
		status: (status) => `Servern svarade med status ${status}.`,
		again: (wait) => `Försök igen om ${wait}.`,
		againNow: 'Du kan försöka igen nu.'
	}
};
