import { withinSentence } from '../../wording/capital.ts';
import type { Text } from '../text.svelte.ts';

export const alarms: Text['alarms'] = {
	title: 'Larm',
	priority: { high: 'Hög', medium: 'Medel', low: 'Låg' },
	priorityOf: { high: 'Hög prioritet', medium: 'Medelhög prioritet', low: 'Låg prioritet' },
	state: {
		unacknowledged: 'inte kvitterat',
		returned: 'inte kvitterat',
		acknowledged: 'kvitterat',
		notice: 'meddelande',
		shelved: 'lagt åt sidan',
		'out-of-service': 'ur drift'
	},
	lasts: (duration) => `i ${duration}`,
	lasted: (duration) => `varade ${duration}`,
	overSince: (when) => `Över sedan ${when}`,
	since: (when) => `sedan ${when}`,
	came: (times) => `kom ${times} gånger`,
	by: (name) => `av ${name}`,
	until: (when) => `till ${when}`,
	causeOver: 'orsaken är över',
	parts: (n) => `${n} till av samma orsak`,
	none: 'Inga larm',
	noneWhenHeard: 'Inga larm när stationen senast hördes',
	noneOfThese: 'Inga av dessa',
	othersHidden: 'Filtret döljer de andra.',
	aside: (n) => `${n} åt sidan eller ur drift`,
	means: 'Vad det innebär',
	todo: 'Vad du ska göra',
	more: (n) => `+${n} till`,
	inHistory: 'Visa i Historik',
	said: {
		alarm: (priority, text) => `Larm, prioritet ${priority.toLowerCase()}: ${text}`,
		live: 'Direkt',
		old: 'Inte direkt: det som visas är gammalt',
		mode: (mode) => `Läge: ${mode}`,
		task: (title) => `Till dig: ${title}`
	},
	which: 'Vilka larm',
	emptyAbout: 'Så snart något är fel står det här, med vad som ska göras åt det.',
	sections: { fresh: 'Inte kvitterade', seen: 'Kvitterade', notices: 'Meddelanden', over: 'Över, i dag' },
	detail: {
		label: 'Det larm som är valt',
		happened: 'Vad som hände',
		means: 'Vad det betyder',
		todo: 'Vad som ska göras',
		came: 'Hur det kom till',
		over: 'Orsaken är över',
		history: 'Allt i Historik'
	},
	silences: {
		'silent.no-message-yet': (of) => (of ? `Inget meddelande än: ${of}` : 'Inget meddelande än'),
		'silent.no-message': (of) => (of ? `Inga meddelanden längre: ${of}` : 'Inga meddelanden längre'),
		'silent.no-message-past': (of) => (of ? `En tid kom inga meddelanden: ${of}` : 'En tid kom inga meddelanden'),
		'silent.no-answer-yet': (of) => (of ? `Inget svar än: ${of}` : 'Inget svar än'),
		'silent.no-answer': (of) => (of ? `Inga svar längre: ${of}` : 'Inga svar längre'),
		'silent.no-answer-past': (of) => (of ? `En tid kom inga svar: ${of}` : 'En tid kom inga svar')
	},
	standing: 'Aktuella',
	setAside: 'Lagda åt sidan och ur drift',
	asideAbout: 'Om dessa får ingen veta något, eftersom någon ville det.',
	acknowledge: 'Kvittera',
	all: {
		button: (n) => `Kvittera alla ${n} som visas`,
		title: (n) => `Kvittera ${n} larm?`,
		means: 'Du säger att du känner till dem. Orsakerna är kvar. Ett som kommer igen under tiden blir inte kvitterat.',
		word: 'Kvittera dessa',
		refused: (n) => (n === 1 ? '1 av dem blev inte kvitterat:' : `${n} av dem blev inte kvitterade:`),
		moved: 'Det kom igen efter att listan gjordes: det är kvar.',
		gone: 'Det är borta eller kvitterat vid det här laget.'
	},
	shelve: {
		ask: 'Lägg åt sidan…',
		button: 'Lägg åt sidan',
		title: 'Lägga larmet åt sidan?',
		means: 'Ingen får veta av det under den tiden. Orsaken är kvar. Blir prioriteten hög visas det genast.',
		how: 'Hur länge',
		span: (minutes) =>
			minutes < 60 ? `${minutes} minuter` : minutes === 60 ? '1 timme' : `${minutes / 60} timmar`,
		until: (when) => `till ungefär ${when}`,
		done: (when) => `Larmet är åsidolagt till ungefär ${when}`,
		back: 'Ta fram igen'
	},
	suppress: {
		ask: 'Ta ur drift…',
		button: 'Ta ur drift',
		title: 'Ta larmet ur drift?',
		means: 'Ingen får veta av det förrän en ingenjör sätter det i drift igen. Orsaken är kvar.',
		done: 'Larmet är ur drift',
		back: 'Sätt i drift igen'
	},
	changed: 'Det har ändrats sedan rutan öppnades:',
	goneNow: 'Larmet är borta.',
	links: {
		resource: (title) => `Tillstånd för ${withinSentence(title)}`,
		topics: (n) => (n === 1 ? 'Dess topic' : `Dess ${n} topics`),
		restart: 'Välj en väg tillbaka',
		label: 'Var man kan titta'
	},
	filter: {
		button: 'Filter',
		label: 'Vilka larm som visas',
		state: 'Tillstånd',
		priority: 'Prioritet',
		resource: 'Resurs',
		any: 'alla',
		option: (word, n) => `${word} (${n})`,
		clear: 'Visa alla',
		shown: (shown, all) => `${shown} av ${all} visas.`
	},
	figures: {
		aside: 'Åt sidan',
		tenMinutes: 'Senaste 10 min',
		hour: 'Senaste timmen',
		course: (each) => `Larm i var tionde minut den senaste timmen: ${each}`,
		floodBegins: 'Larmskur: 10 eller fler på 10 min.',
		atLeast: (n) => `minst ${n}`,
		flood: 'För många för en person.',
		frequent: 'Vanligast',
		times: (n) => (n === 1 ? 'en gång' : `${n} gånger`),
		notKnown: 'inte känt'
	},
	perHour: {
		title: 'Larm per timme',
		span: 'Hur långt tillbaka',
		spans: { 8: '8 h', 24: '24 h' },
		when: 'Timme',
		alarms: 'Larm',
		hour: (from, to) => `${from} till ${to}`,
		n: (n) => `${n} larm`,
		label: (n, hours, worst) => `${n} larm de senaste ${hours} timmarna, som mest ${worst} på en timme`,
		level: (n) => `Prickat: ${n} i timmen. Så många hinner en person följa i längden (ISA-18.2).`,
		tooMany: 'Det var för många larm för att visa alla här. Resten finns i Historik.'
	},
	earlier: {
		title: 'Tidigare',
		about: 'Larm som är över och som människor har tagit del av, det senaste först.',
		caption: 'Larm som är över, det senaste först',
		alarm: 'Larm',
		came: 'Kom',
		ended: 'Upphörde',
		lasted: 'Varade',
		seen: 'Kvitterat av',
		none: 'Inga än',
		howYet: 'Ett larm som är över och har kvitterats kommer hit.',
		older: 'Äldre',
		reading: 'Läser',
		noOlder: 'Det finns inget äldre.',
		operators: 'Operatörer får läsa tidigare larm och hur ofta larm har kommit.'
	},
	tone: {
		on: 'Ljud på',
		off: 'Ljud av',
		label: 'En kort ton för varje nytt larm med hög prioritet',
		about: 'Bara i den här webbläsaren, så länge en av stationens sidor är öppen och direkt. Lita inte på den: enheten kan vara tystad och webbläsaren kan sova.',
		hear: 'Lyssna',
		waiting: 'Inget ljud än: webbläsaren tillåter det när något har tryckts på den här sidan.',
		missing: 'Den här webbläsaren kan inte låta.'
	}
};
