import { count } from '../count.ts';
import type { Text } from '../text.svelte.ts';

export const ability: Text['ability'] = {
	now: 'nu',
	restartOnly: 'endast i omstartsläge',
	person: 'en person gör det',
	place: (file, line) => `${file}, rad ${line}`,
	phases: {
		unknown: 'inte känt',
		idle: 'inte redo',
		enabled: 'redo',
		started: 'startad',
		executing: 'utförs',
		finished: 'färdig'
	},

	automaton: {
		title: 'Automat',
		drawn: (title) => `Automat för ${title}`,
		becomesEnabled: 'är redo när',
		start: 'Start',
		startWhen: 'startar, när det är dess tur, om den är redo och',
		startAlways: 'startar, när det är dess tur, så snart den är redo',
		begins: 'utförs när',
		neverExecutes: 'Den syns aldrig utföras.',
		finish: 'Avslut',
		finishWhen: 'avslutas så snart',
		atOnce: 'Den är klar i och med starten.',
		isFinished: 'är färdig när',
		neverFinished: 'Inget säger att den är färdig: den kan bli redo igen.',
		sets: 'sätter då',
		setsNothing: 'sätter ingenting'
	},
	byItself: {
		title: 'Av sig själv',
		finishes: 'blir klar så fort som',
		now: 'gäller nu',
		whenever: 'Den blir klar så fort det här gäller, vare sig den har startats eller inte:',
		reactions: (n) => count(n, 'reaktion hos enheten', 'reaktioner hos enheten')
	},
	part: {
		always: 'alltid',
		never: 'aldrig',
		holds: 'gäller',
		lacking: 'gäller inte',
		open: 'inte känt',
		is: (name, value) => `${name} är ${value}`
	},
	supervised: {
		title: 'Övervakaren lägger till',
		about: 'Inte skrivet i modellen: funnet genom syntes. Den startar endast om också',
		none: 'Övervakaren lägger inte till något för denna start.',
		pending: 'Vad övervakaren lägger till beräknas fortfarande.',
		noShort: 'Det finns inget kort uttryck för det: tillstånden själva säger när.',
		blocked: 'Inte, bland annat, där:',
		because: 'På grund av:',
		rest: 'att kunna komma till vila igen',
		allows: 'Den skulle tillåta en start nu.',
		forbids: 'Den tillåter ingen start nu.',
		open: 'Om den skulle tillåta en start nu är inte känt.'
	},
	reactions: {
		title: 'Vad enheten väntas göra',
		none: 'Inget sägs om vad enheten gör.',
		kinds: { starting: 'när den startar', executing: 'medan den utförs', finishing: 'efter att den avslutats' },
		when: 'när',
		changes: 'då',
		takes: (from, to) => (from === to ? `på ${from} s` : `på ${from}–${to} s`),
		fault: 'fel',
		faultMeaning: 'Det kan hända; ingen räknar med det.'
	},
	timeouts: {
		title: 'Om det tar för lång tid',
		react: (seconds) => `utförs inte ${seconds} s efter starten`,
		finish: (seconds) => `inte färdig ${seconds} s efter starten`,
		none: 'Det finns ingen gräns: inget larm ges, hur lång tid det än tar.',
		alarm: 'Det blir ett larm, och den fortsätter.',
		replan: (retries) =>
			retries === 0
				? 'Det blir ett larm, den avbryts, och planen går vidare utan den.'
				: `Det blir ett larm, den avbryts och planeras igen, högst ${retries} ${retries === 1 ? 'gång' : 'gånger'}; sedan går planen vidare utan den.`,
		cancel: 'Avbruten sätter den',
		noCancel: 'Den säger inte hur den avbryts: det som pågår går till sitt slut.'
	},
	table: {
		title: 'Som tabell',
		part: 'Del',
		condition: 'Villkor eller handling',
		now: 'Nu',
		values: 'Värden',
		where: 'Skrivet i',
		parts: {
			enabled: 'Redo',
			start: 'Start, villkor',
			startActions: 'Start, handlingar',
			supervised: 'Start, övervakaren',
			executing: 'Utförs',
			finish: 'Avslut, villkor',
			finishActions: 'Avslut, handlingar',
			finished: 'Färdig',
			cancelActions: 'Avbruten, handlingar',
			reaction: (name) => `Väntat: ${name}`
		},
		done: 'satt så',
		undone: 'satt annorlunda'
	},

	trial: {
		title: 'Prova',
		about: 'Startar denna förmåga en gång och inget annat, under samma villkor och samma övervakare som i produktion. Stationen förblir pausad.',
		engineer: 'En ingenjör kan prova en förmåga medan stationen är pausad.',
		word: 'Prova',
		running: 'Den provas.',
		other: 'Något annat utförs.',
		hindered: 'Den kan inte provas nu:',
		stop: 'Stoppa provet',
		stopMeaning: 'Avslutar provet, och avbryter förmågan där den säger hur det görs.',
		real: {
			title: (title) => `Prova ${title} med verkliga enheter?`,
			warning: 'Verkliga enheter rör sig. Ingen får vara där de rör sig, och någon måste kunna stoppa dem vid stationen.',
			found: 'Sett på nätet:',
			unseen: 'Stationen körs inte med emulerade enheter.',
			sure: 'Jag har sett efter: enheten får röra sig.',
			confirm: 'Bekräfta att enheten får röra sig.',
			reason: 'Skäl'
		},
		course: 'Det senaste provet',
		by: (who, why) => (why === '' ? `av ${who}` : `av ${who}: ${why}`),
		none: 'Den har inte provats sedan styrningen startade.',
		steps: { sent: 'sänt', accepted: 'godtaget', started: 'startad', executing: 'utförs', finished: 'färdig', ended: 'slutade ofärdig' },
		marks: { done: 'gjort', now: 'pågår', ahead: 'återstår', never: 'kom inte' },
		because: (why) => `Det slutade: ${why}.`,
		reactions: 'Vad enheten gjorde',
		reaction: {
			came: (after, expected) => `kom efter ${after} (väntat ${expected})`,
			due: (since) => `väntas sedan ${since}`,
			missing: 'kom inte',
			untouched: 'hade ingen anledning att komma',
			faultless: 'hände inte'
		},
		seconds: (s) => `${s.replace('.', ',')} s`
	}
};
