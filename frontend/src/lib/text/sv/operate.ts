import type { Text } from '../text.svelte.ts';

const starts = (n: number): string => (n === 1 ? '1 start' : `${n} starter`);
const runs = (running: boolean): string => (running ? ', som pågår' : '');

export const operate: Text['operate'] = {
	title: 'Drift',
	plan: {
		title: 'Plan',
		asTable: 'som tabell',
		lanes: 'Planen som banor',
		later: (n) => `${n} steg senare än vad som ritas: se tabellen.`,
		steps: 'Planens steg',
		timeShown: 'Visad tid',
		seconds: (n) => (n < 60 ? `${n} s` : `${n / 60} min`),
		statusText: {
			idle: 'Inget att planera',
			planning: 'Planerar',
			followed: 'Följs',
			broken: 'Stationen avvek från planen; en ny söks',
			none: 'Ingen plan hittades'
		},
		replanned: (n) => `omplanerad ${n}×`,
		next: 'Nästa',
		nothingMore: 'Inget mer att starta',
		step: { done: 'klart', running: 'pågår', next: 'nästa', planned: 'planerat' },
		isNew: 'nytt',
		changed: (ago) => `Planen ändrades ${ago}`,
		unchanged: 'Planen har inte tagit någon annans plats.',
		dropped: 'Utgår',
		added: 'Nytt',
		onlyOrder: 'Samma starter i en annan ordning.',
		columns: {
			expected: 'Började eller väntas',
			resource: 'Resurs',
			step: 'Steg',
			status: 'Status',
			lasts: 'Varade eller väntas vara',
			waits: 'Väntar på'
		},
		inSeconds: (n) => (n === 0 ? 'nu' : `om ${n} s`),
		about: (n) => `cirka ${n} s`,
		droppedStatus: 'utgår',
		shortest: (n, ahead) => `Kortaste planen, bevisat: ${n} tick, ${starts(ahead)} kvar`,
		soon: (n, fewest, ahead) =>
			`Plan som hittades snabbt: ${n} tick (${fewest ? 'minsta möjliga' : 'kanske inte minsta möjliga'}), ${starts(ahead)} kvar`,
		ends: (seconds) => `väntas vara klar om cirka ${seconds} s`,
		answered: (time) => `svar på ${time}`,
		answeredBy: (time, engine) => `svar på ${time} av ${engine}`,
		noneWhile: (several) => `Ingen plan så länge ${several ? 'allt detta förblir' : 'detta förblir'} som det är:`,
		perhapsNeedless: 'En del av det kan vara onödigt: det fanns inte tid att ta reda på det.',
		thereWouldBe: (several) => `Det skulle finnas en plan igen med ${several ? 'något av detta' : 'detta'}:`
	},
	why: {
		ask: 'Varför?',
		askOf: (title) => `Varför? ${title}`,
		of: (title) => `Vad ${title} väntar på`,
		nothing: 'Inget är i vägen.',
		again: 'Fråga igen',
		asked: (clock) => `Som det var ${clock}`,
		asking: 'Frågar',
		expanded: 'Vad av det som inte gäller',
		conditions: 'Det väntar tills allt detta gäller',
		kind: {
			station: 'Stationen',
			service: 'I drift',
			written: 'Villkor i modellen',
			unpublished: 'Kommando på väg',
			supervisor: 'Hålls tillbaka av övervakaren',
			plan: 'Plan',
			order: 'Order'
		},
		itIs: (value) => `Det är ${value}`,
		itIsSince: (value, ago) => `Det är ${value}, sedan ${ago}`,
		heardOn: (topic) => `hörs på ${topic}`,
		notConfirmed: 'inte bekräftat',
		changers: 'Kan ändras av',
		nobody: 'ingen',
		how: {
			start: (title, running) => `starten av ${title}${runs(running)}`,
			finish: (title, running) => `slutet av ${title}${runs(running)}`,
			effect: (title, running) => `det som ${title} gör${runs(running)}`,
			correction: () => 'en rättelse av en person',
			force: () => 'att utgången tvingas',
			device: (title) => `någon vid ${title}`,
			message: (title) => `ett meddelande på ${title}`
		},
		plan: (n) => `Det finns en plan: ${starts(n)}.`
	},
	operations: {
		title: 'Operationer',
		activeOf: (active, all) => `${active} av ${all} aktiva`,
		activeFor: (duration) => `aktiv ${duration},`,
		completed: (n) => `${n}× slutförd`,
		once: 'utförs en gång: aktiv igen efter återställning',
		out: 'ur drift',
		asked: {
			none: () => 'inget jobb kräver den',
			later: (job) => `senare i ${job}`,
			now: (job) => `för ${job}`,
			done: (job) => `klar för ${job}`,
			skipped: (job) => `behövs inte för ${job}`
		},
		leftOut: 'utanför planen'
	},
	resources: {
		title: 'Resurser',
		product: 'Produkt',
		online: 'ansluten',
		offline: 'tyst',
		out: 'ur drift',
		estimated: 'uppskattat',
		commanded: 'beordrat',
		unknown: 'okänt',
		awaitsAll: 'Inväntar',
		awaits: 'inväntar',
		nothingRuns: 'inget pågår',
		notConfirmed: 'inte bekräftat',
		forced: 'tvingat',
		all: (n) => `Alla ${n} värden`,
		allOf: (n, title) => `Alla ${n} värden för ${title}`,
		abilities: (n) => (n === 1 ? '1 förmåga' : `${n} förmågor`),
		runs: 'pågår',
		restartOnly: 'bara vid omstart'
	},
	service: {
		title: 'Ur drift',
		of: { resource: 'resurs', ability: 'förmåga', operation: 'operation' },
		since: (clock, by, why) => `sedan ${clock}, ${by}: ${why}`,
		byStation: 'stationen gav upp den',
		putBack: 'Ta i drift',
		putBackTitle: (title) => `Ta ${title} i drift igen?`,
		becauseOf: (why) => `Den togs ur drift därför att: ${why}`,
		takeOut: 'Ta ur drift',
		takeOutOf: (title) => `Ta ur drift: ${title}`,
		takeOutTitle: (title) => `Ta ${title} ur drift?`,
		means: {
			resource: 'Dess förmågor startar inte, och inget som dess enheter skulle göra räknas med. Det som pågår fortsätter. Planer görs utan den tills någon tar den i drift igen.',
			ability: 'Den startar inte; det som pågår av den fortsätter. Planer görs utan den tills någon tar den i drift igen.',
			operation: 'Den blir inte aktiv, och är inte längre aktiv, tills någon tar den i drift igen.'
		}
	},
	whoCan: {
		title: 'Vem kan göra vad',
		nobody: (n) => (n === 1 ? 'Detta kan ingen göra nu' : 'Dessa kan ingen göra nu'),
		lacks: (what) => `behöver ${what}`,
		others: 'Detta kan fortfarande göras',
		by: (whom) => `av ${whom}`,
		goesOn: 'av det som redan pågår',
		once: (what) => `så snart ${what}`,
		later: (n) => (n === 1 ? '1 som kommer senare' : `${n} som kommer senare`),
		absent: { silent: 'hörs inte', 'out of service': 'är ur drift' }
	},
	topics: {
		title: 'Topics',
		never: 'aldrig',
		silent: 'tyst',
		in: 'in',
		out: 'ut',
		peers: (n) => (n === 1 ? '1 motpart' : `${n} motparter`)
	},
	supervisor: {
		title: 'Övervakare',
		computed: (what) => `Beräknas: ${what}.`,
		guards: (n) => (n === 1 ? '1 tillagt villkor' : `${n} tillagda villkor`),
		onlyWhen: 'bara när',
		noShort: 'inget kort villkor säger det',
		blocked: 'Inte, bland annat, där:',
		expanded: 'Utskrivet',
		over: (index) => `för ${index}`,
		because: 'på grund av',
		rest: 'att åter komma till vila',
		none: 'Det finns ingen övervakare, så inget startas.',
		about: (number) => `cirka ${number}`,
		reached: (number) => `${number} tillstånd kan nås`,
		supervised: (number) => `${number} av dem med övervakaren`,
		atMost: (number) => `Högst ${number} tillstånd kan nås med övervakaren`,
		fromBeginning: 'Det är så från början',
		howItComes: (n) => `Hur det uppstår, i ${n} steg`,
		kind: { tick: 'Tick', start: 'Start', activity: 'Operation', transition: 'Steg' },
		finished: 'klart:',
		nothingChanges: 'inget ändras',
		forbiddenBy: 'förbjuds av'
	},
	problem: {
		more: 'Mer om det (om du vill)',
		title: (task) => `Vad hindrar ”${task}”?`,
		means: 'Det ger ett larm, så att någon kommer. Inget stannar av det, och uppgiften är kvar.',
		tell: 'Säg till stationen'
	}
};
