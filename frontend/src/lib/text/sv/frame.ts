import type { Text } from '../text.svelte.ts';

export const frame: Text['frame'] = {
	pages: 'Sidor',
	/** Groups of pages. */
	groups: { operate: 'Drift', engineer: 'Teknik', plant: 'Anläggning' },
	skip: 'Hoppa till sidan',
	collapse: 'Fäll ihop',
	expand: 'Fäll ut',
	morePages: 'Mer',
	emulated: 'Emulerad',
	emulatedMeans: 'Enheterna är emulerade.',
	mode: {
		automatic: 'Automatik',
		paused: 'Pausad',
		hold: 'Stoppad',
		restart: 'Omstart'
	},
	meaning: {
		automatic: 'Operationer utförs.',
		paused: 'Pågående steg blir klara. Inget nytt startar.',
		hold: 'Inget startar. Det som kunde stoppas har stoppats.',
		restart: 'Operationerna väntar. Bara det du godkänner startar.'
	},
	nothingSent: 'Enheterna får inga kommandon innan produktionen startar.',
	production: {
		preparing: 'Förbereder. Inget startas.',
		waiting: 'Redo. Produktionen är inte startad.',
		started: 'Produktionen är startad.'
	},
	preparing: 'Styrningen lyssnar bara, och frågar nätet om någon annan styr samma enheter. Inga kommandon tas emot innan det är känt.',
	standby: ({ active, holder, trouble }) => {
		if (trouble !== null) return `Det här är en av flera stationer, och den kan inte ta befälet: ${trouble}.`;
		if (!active) return `Den här stationen står i reserv: ${holder ?? 'ingen'} styr enheterna.`;
		return 'Ingen annan station står i reserv: ingen skulle ta över efter den här.';
	},
	beingComputed: (what) => `Beräknas: ${what}.`,
	packml: {
		resetting: 'Resetting',
		idle: 'Idle',
		execute: 'Execute',
		suspended: 'Suspended',
		holding: 'Holding',
		held: 'Held',
		stopping: 'Stopping',
		stopped: 'Stopped',
		aborted: 'Aborted',
		clearing: 'Clearing'
	},
	stepByStep: 'Steg för steg',
	pausesAfter: 'sedan paus',
	pausedAfter: 'produkten klar',
	atBreakpoint: 'brytpunkt',
	pausesBy: (who, why) => `Stationen pausar när produkten är klar, som ${who} bad om${why === '' ? '.' : `: ${why}`}`,
	pause: 'Pausa',
	hold: 'Stoppa',
	holdMeans: 'Pausa, och avbryt det som pågår',
	notRecorded: 'Stoppad. Journalen har det inte än; stationen behåller det så länge.',
	goOn: 'Fortsätt',
	start: 'Starta produktionen',
	takeControlFirst: 'Ta kontrollen först',
	lookOn: (role) => `Du ser på som ${role}; en operatör agerar.`,
	alarms: (n) => `${n} larm`,
	waits: {
		said: (number, name, by) => `Revision ${number}, ”${name}”, av ${by} väntar på en andra persons godkännande.`,
		look: 'Se ändringarna'
	},
	undeployed: (n) => (n === 1 ? '1 ändring är inte driftsatt' : `${n} ändringar är inte driftsatta`),
	noAlarms: 'Inga larm',
	alarmsWhenHeard: (n, over) =>
		n > 0 ? `${n} larm när den senast hördes` : over > 0 ? `${over} upphörda, okvitterade när den senast hördes` : 'Inga larm när den senast hördes',
	moreAlarms: (n) => `+${n}`,
	alarmsOver: (n) => `${n} upphörda, okvitterade`,
	notAcknowledged: (n) => `${n} okvitterade`,
	notLive: 'Inte direkt',
	notLiveFor: (age) => `Inte direkt · ${age} gammalt`,
	connecting: 'Ansluter',
	notLiveStrong: 'Inte direkt.',
	lastHeard: (age) => `Det som visas är ${age} gammalt. Stationen kan ha gått vidare.`,
	tryNow: 'Försök nu',
	relyNot: 'Inget som skickas härifrån kommer säkert fram, inte heller Pausa och Stoppa.',
	safetyDevices: 'Stoppa med stationens skyddsanordningar, till exempel nödstoppet.',
	notUnderstood: (what) => `Servern förstod inte den här sidan: ${what}`,
	causes: {
		connecting: 'Ansluter till stationen.',
		closed: 'Förbindelsen med servern är bruten. Försöker igen.',
		controller: 'Servern hör inte styrningen.',
		gap: 'Ett meddelande gick förlorat. Läser in igen.',
		silent: 'Inget nytt har kommit från servern.'
	},
	mayStart: 'får starta nu',
	nothingNext: {
		idle: 'inget att planera',
		order: 'ordern är pausad; den återupptas under Order',
		noOrder: 'väntar på en order som får börja',
		planning: 'en plan söks',
		followed: 'inget mer att starta',
		waits: 'väntar på stegen som pågår',
		broken: 'stationen avvek från planen; en ny söks',
		none: 'ingen plan hittades',
		paused: 'inget startas i detta läge',
		production: 'inget startas innan produktionen är startad'
	},
	release: 'Släpp',
	round: {
		offer: 'Ny här? Fem korta steg visar dig runt.',
		show: 'Visa mig runt',
		notNow: 'Inte nu',
		skip: 'Hoppa över',
		back: 'Tillbaka',
		next: 'Nästa',
		end: 'Börja arbeta',
		stepOf: (n, all) => `Steg ${n} av ${all}`,
		steps: [
			{ title: 'Stationen', text: 'Bilden är stationen som den är nu: vad varje enhet gör och hur långt produkten har kommit. Tryck på något i den för att se dess värden och varför det väntar.' },
			{ title: 'Planen', text: 'Vad som pågår, vad som kommer sedan och vad som väntar på vad. När stationen ändras görs planen om.' },
			{ title: 'Din uppgift', text: 'Här står vad stationen ber dig om. Gör det och tryck sedan på Klart. Går det inte, tryck på Problem: någon kommer, och inget stannar.' },
			{ title: 'Pausa och Stoppa', text: 'Pausa: pågående steg görs klara, inget nytt startar. Stoppa: det som kan stoppas stannar genast. Båda finns på varje sida och frågar inget. Ingen av dem är ett nödstopp.' },
			{ title: 'När det stannar', text: 'Ett larm säger vad som är fel och vad du kan göra. Sidan Omstart leder sedan tillbaka till produktion, ett steg i taget.' }
		]
	},
	notices: 'Meddelanden',
	help: (page) => `Hjälp: ${page}`,
	search: 'Sök eller gör',
	stopSaid: {
		arrived: { paused: 'Pausa har nått stationen. Det som visas är fortfarande gammalt.', hold: 'Stoppa har nått stationen. Det som visas är fortfarande gammalt.' },
		notSent: { paused: 'Pausa skickades inte.', hold: 'Stoppa skickades inte.' },
		noAnswer: { paused: 'Pausa fick inget svar: ingen vet om det har kommit fram.', hold: 'Stoppa fick inget svar: ingen vet om det har kommit fram.' }
	},
	palette: {
		title: 'Sök eller agera',
		missing: 'Det gick inte att läsa in. Ladda sidan igen.',
		hint: 'En sida, variabel, förmåga, operation eller åtgärd',
		nothing: (typed) => `Inget heter ”${typed}”.`,
		examples: 'Exempelstationer',
		why: {
			waits: (operation) => `Varför väntar ”${operation}”?`,
			active: (operation) => `När är ”${operation}” klar?`,
			stopped: (operation) => `Varför står ”${operation}” still?`,
			done: (operation) => `”${operation}” är klar. När börjar den igen?`
		},
		groups: { act: 'Möjligt nu', page: 'Sidor', alarm: 'Larm', operation: 'Operationer', ability: 'Förmågor', variable: 'Variabler' }
	},
	noStation: 'Inget är känt om stationen än.',
	asOf: (clock) => `som det var ${clock}`,
	asTable: 'som tabell',
	takeBack: 'Ta tillbaka',
	takenBack: 'Genast tillbakataget',
	reasonMissing: 'Skriv varför: det står i journalen.',
	needed: '(måste anges)'
};
