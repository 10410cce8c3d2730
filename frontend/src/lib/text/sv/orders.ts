import { count } from '../count.ts';
import type { Text } from '../text.svelte.ts';

export const orders: Text['orders'] = {
	summary: (made, left, held, last) => {
		const open = [left > 0 || held === 0 ? `${left === 0 ? 'inga' : left} ska tillverkas` : '', held > 0 ? `${held} inte släppta` : ''];
		return `${made} tillverkade på order i dag, ${open.filter(Boolean).join(', ')}${last === null ? '' : `; den sista väntas vara klar ${last}`}`;
	},
	work: 'Hur stationen arbetar',
	ways: {
		order: {
			name: 'På order',
			means: 'Stationen gör bara det som är beställt.',
			title: 'Låta stationen arbeta på order?',
			word: 'Arbeta på order',
			follows: 'Från och med nu gör stationen bara det som är beställt. Det som är i arbete utan order lämnas ofärdigt.'
		},
		freely: {
			name: 'Fritt',
			means: 'Stationen fortsätter själv med nästa produkt, och order väntar.',
			title: 'Låta stationen arbeta fritt?',
			word: 'Arbeta fritt',
			follows: 'Från och med nu fortsätter stationen själv med nästa produkt, och order väntar.'
		}
	},
	columns: { stored: 'Inte släppta', waiting: 'Väntar', worked: 'I arbete', over: 'Avslutade i dag' },
	madeOf: (n) => `${n} tillverkade`,
	noneYet: {
		title: 'Inga order än',
		unknown: 'Om det finns order är inte känt',
		impossible: 'Inget kan beställas',
		freely: 'Stationen arbetar fritt: den fortsätter själv med nästa produkt. Med en order säger du vad som ska göras och när det ska vara klart; ett MES kan också skicka order.',
		byOrder: 'Stationen arbetar efter order: den gör inget förrän det finns en. Order kommer från ett MES, eller görs här.'
	},
	empty: {
		stored: 'Här står order tills någon låter dem börja.',
		waiting: 'Här står order som får börja, i den ordning de ska börja.',
		worked: 'Ingen order i arbete.',
		over: 'Ingen order har avslutats i dag.'
	},
	before: (n) => count(n, 'order före i dag', 'order före i dag'),
	moreThanShown: 'Det finns fler order än som visas här.',
	next: 'nästa',
	more: (title) => `Mer för ${title}`,
	priority: 'Prioritet',
	priorityOf: (n) => `prioritet ${n}`,
	due: 'Klar senast',
	dueAt: (time) => `senast ${time}`,
	startsAt: (time) => `börjar ${time}`,
	readyAt: (time) => `klar ${time}`,
	soFar: (time) => `${time} hittills`,
	id: 'Nummer',
	began: 'Påbörjad',
	stored: 'Lagrad',
	expectedStart: 'Väntas börja',
	expectedEnd: 'Väntas vara klar',
	operations: 'Operationer',
	steps: { waiting: 'väntar', eligible: 'kan börja', active: 'pågår', completed: 'klar', skipped: 'behövs inte' },
	pauseMeans: 'Av en pausad order påbörjas ingen operation; det som pågår får bli klart. Stationen stoppas med Pausa eller Stoppa ovan.',
	states: {
		NotAllowedToStart: 'inte släppt',
		AllowedToStart: 'väntar',
		Running: 'pågår',
		Interrupted: 'pausad',
		Ended: 'avslutad',
		Aborted: 'nedlagd'
	},
	standstill: { stopped: 'står', waits: 'väntar' },
	pausedBecause: (why) => `Pausad: ${why}`,
	commands: {
		Start: 'Låt börja',
		RevokeStart: 'Låt inte börja än',
		Pause: 'Pausa ordern',
		Resume: 'Fortsätt ordern',
		Stop: 'Stoppa efter operationen',
		Abort: 'Lägg ned ordern',
		Cancel: 'Ta bort ordern',
		Clear: 'Rensa ordern'
	},
	commandOf: (command, title) => `${command}: ${title}`,
	commandTitle: (command, title) => `${command}: ${title}`,
	means: {
		Start: 'Den börjar när dess tur kommer.',
		RevokeStart: 'Den börjar inte förrän någon låter den börja igen.',
		Pause: 'Ingen av dess operationer påbörjas; det som pågår får bli klart.',
		Resume: 'Dess operationer går vidare. Enheter kan röra sig genast.',
		Stop: 'Det som är aktivt slutförs, och inget mer påbörjas.',
		Abort: 'Det som är aktivt läggs åt sidan genast; det som pågår får bli klart.',
		Cancel: 'Ordern tas bort, och inget av den tillverkas.',
		Clear: 'Ordern visas inte längre. Journalen behåller den.'
	},
	commanded: (command) => `Begärt: ${command}. Det är inte gjort än.`,
	progress: (done, all) => `${done} av ${all}`,
	waits: (reasons) => `Väntar: ${reasons}`,
	late: (time) => `${time} sen`,
	lateAtMost: (time) => `under ${time} sen`,
	notBefore: (time) => `inte före ${time}`,
	by: (name) => `från ${name}`,
	found: 'Bäst för de sluttider och varaktigheter som är kända.',
	freely: 'Inga tider än: stationen arbetar fritt, och order väntar.',
	foundSoon: 'Den bästa som hann hittas för de sluttider och varaktigheter som är kända.',
	foundNot: (why) => `Efter prioritet och sluttid: ${why}.`,
	line: {
		title: 'Arbetsordning',
		window: 'Del av tidslinjen',
		station: 'Station',
		minutes: (n) => `${n} min`,
		hours: (n) => `${n} h`,
		dueLane: 'Klar senast',
		dueOf: (title, time) => `${title}, klar senast ${time}`,
		unknown: 'ingen vet när',
		late: 'sen',
		withoutTime: (n) => (n === 1 ? '1 order har ingen väntad tid än.' : `${n} order har ingen väntad tid än.`),
		bars: {
			past: (title, from, to) => `${title}, tillverkad från ${from} till ${to}`,
			run: (title, from, to) => `${title}, i arbete sedan ${from}, klar: ${to}`,
			next: (title, from, to) => `${title}, nästa: från ${from} till ${to}`,
			plan: (title, from, to) => `${title}, väntas från ${from} till ${to}`
		}
	},
	newTitle: 'Ny order',
	workMaster: 'Vad som tillverkas',
	noWorkMaster: 'Stationens modell har ingen arbetsmall, så inget kan beställas. En ingenjör lägger till en på sidan Modell.',
	description: 'Beskrivning',
	first: 'Den högsta tillverkas först. 0 är det normala.',
	earliest: 'Inte före',
	startAtOnce: 'Släpp den nu: den tillverkas när det är dess tur',
	store: 'Lägg till order',
	isStored: (title) => `Ordern ${title} är på tavlan.`,
	done: (command, title) => `${command}: ${title}. Klart.`,
	outcomes: { completed: 'slutförd', stopped: 'stoppad', aborted: 'nedlagd', cancelled: 'borttagen' },
	reason: 'Orsak',
	operationsMade: (done, all) => `${done} av ${all} operationer slutförda`,
	startsMade: (n) => count(n, 'start av en förmåga', 'starter av förmågor'),
	corrections: (n) => count(n, 'rättelse', 'rättelser'),
	deviations: (n) => count(n, 'avvikelse', 'avvikelser'),
	wentOtherwise: 'Vad som blev annorlunda',
	details: (title) => `Vad som tillverkades för ${title}`,
	operation: 'Operation',
	from: 'Från',
	took: 'Tog',
	because: (by, why) => `${by}: ${why}`
};
