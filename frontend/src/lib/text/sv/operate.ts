import { withinSentence } from '../../wording/capital.ts';
import type { Text } from '../text.svelte.ts';

const starts = (n: number): string => (n === 1 ? '1 start' : `${n} starter`);
const runs = (running: boolean): string => (running ? ', som pågår' : '');

export const operate: Text['operate'] = {
	change: {
		product: (name) => `Modellen byts till ”${name}” när produkten är klar.`,
		orders: (name) => `Modellen byts till ”${name}” när ordrarna i arbete är klara.`,
		by: (who, at, why) => `${who}, ${at}: ${why}`
	},
	title: 'Drift',
	plan: {
		wayBack: 'beror på vägen tillbaka',
		title: 'Plan',
		asTable: 'som tabell',
		aboutPlan: 'Om planen',
		operation: 'Operation',
		whole: 'Allt',
		waiting: 'Väntar',
		waitsFor: (people) => `Väntar på ${people}`,
		plannedFor: (seconds) => (seconds < 100 ? `planerat för ${seconds} s` : `planerat för ${Math.round(seconds / 60)} min`),
		since: { broken: (at) => `Bröts ${at}`, none: (at) => `Ingen plan sedan ${at}`, stopped: (at) => `Stoppade ${at}` },
		stopped: 'stoppat',
		after: (title) => `efter ${title}`,
		lanes: 'Planen som banor',
		later: (n) => `${n} steg senare än vad som ritas: se tabellen.`,
		steps: 'Planens steg',
		timeShown: 'Visad tid',
		seconds: (n) => (n < 60 ? `${n} s` : `${n / 60} min`),
		statusText: {
			planning: 'Planerar',
			followed: 'Följs'
		},
		replanned: (n) => `Planerad igen ${n === 1 ? 'en gång' : `${n} gånger`}.`,
		next: 'Nästa',
		step: { done: 'klart', running: 'pågår', next: 'nästa', planned: 'planerat' },
		isNew: 'nytt',
		unheard: 'pågick när den sist hördes',
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
		shortest: (ahead) => `Den kortaste planen som finns, bevisat: ${starts(ahead)} kvar.`,
		soon: (fewest, ahead) => `Snart funnen: ${starts(ahead)} kvar. ${fewest ? 'Ingen plan är kortare.' : 'Det kan finnas en kortare plan.'}`,
		ends: (seconds) => `Klar om cirka ${seconds} s.`,
		answered: (time) => `Funnen på ${time}.`,
		answeredBy: (time, engine) => `Funnen på ${time} av ${engine}.`,
		whyNone: 'Varför det inte finns någon plan',
		noneWhile: (several) => `Ingen plan så länge ${several ? 'allt detta förblir' : 'detta förblir'} som det är:`,
		perhapsNeedless: 'En del av det kan vara onödigt: det fanns inte tid att ta reda på det.',
		thereWouldBe: (several) => `Det skulle finnas en plan igen med ${several ? 'något av detta' : 'detta'}:`
	},
	why: {
		ask: 'Varför?',
		askOf: (title) => `Varför? ${title}`,
		of: (title) => `Vad ”${title}” väntar på`,
		doneOf: (title) => `”${title}” är klar`,
		beginsAgain: 'Den börjar igen när',
		nothing: 'Inget är i vägen.',
		goalHolds: 'Den är klar.',
		again: 'Fråga igen',
		asked: (clock) => `Som det var ${clock}`,
		asking: 'Frågar',
		kind: {
			station: 'Stationen',
			service: 'I drift',
			written: 'Villkor i modellen',
			unpublished: 'Kommando på väg',
			supervisor: 'Hålls tillbaka av övervakaren',
			plan: 'Plan',
			order: 'Order'
		},
		since: (value, time) => `${value}, sedan ${time}`,
		heardOn: (topic) => `hörs på ${topic}`,
		notConfirmed: 'inte bekräftat',
		changers: 'Kan ändras av',
		nobody: 'ingen',
		how: {
			start: (title, running) => `starten av ”${title}”${runs(running)}`,
			finish: (title, running) => `slutet av ”${title}”${runs(running)}`,
			effect: (title, running) => `det som ”${title}” gör${runs(running)}`,
			correction: () => 'en rättelse av en person',
			force: () => 'att utgången forceras'
		},
		plan: (n) => `Det finns en plan: ${starts(n)}.`,
		about: {
			enabled: 'Den kan starta när',
			start: 'Den startar när',
			supervisor: 'Övervakaren tillåter den när',
			finish: 'Den är klar när',
			precondition: 'Den börjar när',
			turn: 'Det är dess tur när',
			goal: 'Den är klar när',
			undone: 'Varför den är klar',
			predicate: 'Det är så när'
		},
		sake: (titles) => `för ${titles}`,
		toRest: 'så att stationen kan komma till vila igen',
		inSequence: (name) => `i sekvensen ${name}`,
		truth: { holds: 'gäller', fails: 'gäller inte', open: 'inte känt' },
		joined: {
			all: 'Allt detta:',
			any: 'Något av detta:',
			not: 'Inte detta:',
			implies: 'Det andra, om det första:',
			same: 'Det betyder:'
		},
		called: (predicate) => `heter ${predicate}`,
		mustEnd: 'får inte vara så',
		others: (n) => (n === 1 ? '1 till, som inte avgör' : `${n} till, som inte avgör`),
		above: 'står ovanför',
		operation: (title) => `operationen ${title}`
	},
	operations: {
		title: 'Operationer',
		plural: (word) => word,
		startFirst: 'Börjar när produktionen har startats',
		modeFirst: 'Väntar på automatik',
		soAlready: 'Behövs inte nu',
		noOrder: 'Ingen order kräver den',
		orderPaused: 'Dess order är pausad',
		laterInOrder: 'Kommer senare i sin order',
		doneOf: (done, all) => `${done} av ${all} klara`,
		of: (done, all) => `${done} av ${all}`,
		stopped: 'stoppad',
		standing: { done: 'klar', active: 'aktiv', stopped: 'stoppad', waits: 'väntar' },
		none: 'Inga operationer',
		noneHow: 'Vad stationen gör står i modellen.',
		completed: (n) => `${n}× slutförd`,
		once: 'utförs en gång: aktiv igen efter återställning',
		out: 'ur drift',
		asked: {
			later: (job) => `senare i ${job}`,
			now: (job) => `för ${job}`,
			done: (job) => `klar för ${job}`,
			skipped: (job) => `behövs inte för ${job}`
		},
		leftOut: 'utanför planen'
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
		isOut: (title) => `${title} är ur drift`,
		isBack: (title) => `${title} är i drift igen`,
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
		by: (whom) => `av ${withinSentence(whom)}`,
		goesOn: 'av det som redan pågår',
		once: (what) => `så snart ${what}`,
		later: (n) => (n === 1 ? '1 som kommer senare' : `${n} som kommer senare`),
		counts: (nobody, others) =>
			[nobody > 0 ? `${nobody} kan inte göras nu` : '', others > 0 ? `${others} kan fortfarande göras` : ''].filter(Boolean).join(' · '),
		absent: { silent: () => 'hörs inte', 'out of service': () => 'är ur drift' }
	},
	supervisor: {
		noShort: 'inget kort villkor säger det',
		blocked: 'Inte, bland annat, där:',
		expanded: 'Utskrivet',
		none: 'Det finns ingen övervakare, så inget startas.',
		about: (number) => `cirka ${number}`,
		reached: (number) => `${number} tillstånd kan nås`,
		supervised: (number) => `${number} av dem med övervakaren`,
		atMost: (number) => `Högst ${number} tillstånd kan nås med övervakaren`
	},
	task: {
		yours: 'Din uppgift',
		notStarted: 'Produktionen är inte startad',
		startAbove: 'Starta den i listen ovanför när stationen är klar. Innan dess skickas inget till enheterna.',
		startHere: 'Inget skickas till enheterna innan en person startar den.',
		startedBy: (name) => `${name} har kontrollen och kan starta den.`,
		comesHere: 'Det stationen ber dig om kommer hit.',
		goesOn: 'Din uppgift fortsätter',
		toldAbove: 'Problemet berättas ovan',
		thenBegins: 'Sedan börjar:',
		thenMoves: 'Sedan rör sig:',
		mayMove: (who) => `${who} kan röra sig så snart det här är klart: håll undan.`,
		next: 'Nästa för dig:',
	},
	problem: {
		more: 'Mer om det',
		title: (task) => `Vad hindrar ”${task}”?`,
		means: 'Det ger ett larm, så att någon kommer. Inget stannar av det, och uppgiften är kvar.',
		tell: 'Säg till stationen'
	}
};
