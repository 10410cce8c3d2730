import type { Text } from '../text.svelte.ts';

export const header: Text['header'] = {
	pages: 'Sidor',
	menu: 'Meny',
	/** Groups of pages. */
	groups: { operation: 'Drift', engineering: 'Teknik' },
	emulated: 'emulerade enheter',
	mode: {
		automatic: 'Automatik',
		paused: 'Pausad',
		hold: 'Stannad',
		restart: 'Omstart'
	},
	meaning: {
		automatic: 'Operationer utförs.',
		paused: 'Det som pågår får bli klart; inget startas.',
		hold: 'Inget startas, och det som pågick har avbrutits där det går.',
		restart: 'Operationerna väntar. Inget startas utom det som en person har sett på och valt.'
	},
	nothingSent: 'Inget skickas till enheterna förrän produktionen är startad.',
	production: {
		preparing: 'förbereds: inget rör sig än',
		waiting: 'väntar på att produktionen startas',
		started: 'produktionen är startad'
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
	stepByStep: 'steg för steg',
	control: (who) => `kontroll: ${who}`,
	pause: 'Pausa',
	hold: 'Stanna',
	holdMeans: 'Pausa, och avbryt det som pågår',
	notRecorded: 'Stoppad. Journalen har det inte än; stationen behåller det så länge.',
	goOn: 'Fortsätt',
	start: 'Starta produktionen',
	takeControlFirst: 'Ta kontrollen först',
	lookOn: (role) => `Du ser på som ${role}; en operatör agerar.`,
	alarms: (n) => `${n} larm`,
	noAlarms: 'inga larm',
	alarmsOver: (n) => `${n} över, inte kvitterade`,
	notAcknowledged: (n) => `${n} okvitterade`,
	liveAgo: (age) => `direkt för ${age} sedan`,
	notLive: 'inte direkt',
	notLiveFor: (age) => `inte direkt, ${age} gammalt`,
	connecting: 'ansluter',
	notLiveStrong: 'Inte direkt.',
	lastHeard: (age) => `Det som visas är gammalt: senast hört för ${age} sedan.`,
	notUnderstood: (what) => `Servern förstod inte den här sidan: ${what}`,
	causes: {
		connecting: 'Ansluter till stationen.',
		closed: 'Förbindelsen med servern är bruten. Försöker igen.',
		controller: 'Servern hör inte styrningen.',
		gap: 'Ett meddelande gick förlorat på vägen. En ny bild har begärts.',
		silent: 'Inget nytt har kommit från servern.'
	},
	carriedOut: 'Utförs',
	by: (name) => `av ${name}`,
	active: 'Aktivt',
	noOperation: 'ingen operation',
	next: 'Nästa',
	more: (n) => `och ${n} till`,
	waitsFor: 'väntar på',
	mayStart: 'får starta nu',
	nothingNext: {
		idle: 'inget att planera',
		planning: 'en plan söks',
		followed: 'inget mer att starta',
		waits: 'inget att starta: det som pågår inväntas',
		broken: 'stationen avvek från planen; en ny söks',
		none: 'ingen plan hittades',
		paused: 'inget startas i detta läge',
		production: 'inget startas innan produktionen är startad'
	},
	release: 'Släpp'
};
