import { count } from '../count.ts';
import type { Text } from '../text.svelte.ts';

export const deploy: Text['deploy'] = {
	lookOn: (role) => `Som ${role} kan du se på och jämföra. Ingenjörer sparar, tar tillbaka och driftsätter.`,
	notRead: 'Revisionerna läses.',
	notLive: 'Inte direkt: vänta tills utkastet hörs igen.',
	toModel: 'Till modellen',
	toCheck: 'Till Granskning',
	toOperate: 'Till Drift',

	draft: {
		title: 'Utkastet',
		after: (number) => `Efter ändring ${number}`,
		last: (title, by, clock) => `${title} (${by}, ${clock})`,
		same: 'Stationen kör detta utkast.',
		differs: (n) => `Det skiljer sig från det som körs i ${count(n, 'fil', 'filer')}:`,
		state: { new: 'ny', changed: 'ändrad', removed: 'borttagen', same: 'likadan' },
		saved: (name) => `Sparat som ”${name}”.`,
		unsaved: 'Inte sparat som revision.',
		save: 'Spara revision …',
		deploy: 'Driftsätt …',
		compare: 'Jämför med det som körs'
	},

	revisions: {
		title: 'Revisioner',
		none: 'Ingen revision har sparats än',
		howYet: 'Spara utkastet som en: den kan jämföras, driftsättas och återgås till härifrån.',
		unnamedRuns: 'Det som körs är ingen av dem.',
		name: 'Revision',
		message: 'Meddelande',
		by: 'Sparad av',
		time: 'När',
		acts: 'Åtgärder',
		runs: 'körs',
		draft: 'utkast',
		compare: 'Jämför …',
		back: 'Tillbaka till revisionen …'
	},

	save: {
		title: 'Spara utkastet som revision',
		name: 'Namn',
		nameHint: 'Kort, och inte en annan revisions: högst 100 tecken.',
		message: 'Meddelande',
		word: 'Spara',
		done: (name) => `”${name}” är sparad.`,
		wrong: {
			empty: 'Den behöver ett namn.',
			long: 'Namnet är längre än 100 tecken.',
			taken: (name) => `Det finns redan en revision ”${name}”: välj ett annat namn.`,
			same: (name) => `Inget skiljer sig från revisionen ”${name}”, den senast sparade.`
		}
	},

	back: {
		title: (name) => `Tillbaka till ”${name}”?`,
		means: 'Utkastet blir denna revision. Inget som körs berörs.',
		undone: 'Det är en ändring av utkastet och kan ångras i Modell som varje annan.',
		unsaved: 'Utkastet som det är nu är inte sparat som revision: Ångra är enda vägen tillbaka till det.',
		word: 'Ta tillbaka den',
		done: (name) => `Utkastet är ”${name}” igen. Det granskas.`
	},

	compare: {
		over: (index: string): string => `för ${index}`,
		expanded: 'Utskrivet',
		title: 'Jämför',
		old: 'Den äldre',
		new: 'Den nyare',
		running: 'det som körs',
		draft: 'utkastet',
		swap: 'Byt plats',
		word: 'Jämför',
		equal: 'Välj två som inte är samma.',
		asking: 'De jämförs. Det tar några sekunder.',
		since: (seconds) => `${seconds} s`,
		of: (old, newer) => `Från ${old} till ${newer}`,
		outdated: 'En av dem har ändrats sedan dess: jämför igen.',
		nothing: 'De skiljer sig inte.',
		behaviour: 'Beteende',
		text: 'Text',
		obstacle: 'Deras beteende kan inte jämföras:',
		sameBehaviour: 'De beter sig lika.',
		before: 'Innan',
		after: 'Efter',
		part: 'Vad',
		nothingSaid: 'inget',
		state: { new: 'ny', gone: 'borta', changed: 'ändrad' },
		mark: { new: '+', gone: '−', changed: '≠' },
		counted: (news, gone, changed) => `${news} nya, ${gone} borta, ${changed} ändrade`,
		kind: {
			variable: 'Variabler',
			ability: 'Förmågor',
			effect: 'Verkningar',
			operation: 'Operationer',
			specification: 'Specifikationer',
			station: 'Stationen'
		},
		parts: {
			kind: 'sort',
			values: 'värden',
			initial: 'begynnelsevärde',
			enabled: 'möjlig när',
			start: 'får starta när',
			'start actions': 'vid start',
			executing: 'pågår medan',
			finished: 'är klar när',
			finish: 'avslutas när',
			'finish actions': 'vid avslut',
			cancel: 'när den avbryts',
			'added by the supervisor': 'tillagt av övervakaren',
			restart: 'bara för omstart',
			task: 'uppgift',
			when: 'när',
			does: 'gör',
			takes: 'tar',
			precondition: 'förvillkor',
			goal: 'mål',
			local: 'lokal specifikation',
			priority: 'prioritet',
			forbidden: 'förbjudet',
			'states of rest': 'vilotillstånd'
		},
		abilities: 'Vad som kan starta där det inte kunde, eller inte längre kan',
		gained: 'Bara i den nyare kan den starta',
		lost: 'Bara i den äldre kan den starta',
		fromBeginning: 'från början.',
		run: (n) => `efter ${count(n, 'start', 'starter')}:`,
		plans: 'Planer för operationer från begynnelsetillståndet',
		noPlan: 'ingen plan',
		starts: (n) => count(n, 'start', 'starter'),
		file: (path) => `Skillnader i ${path}`,
		lines: (added, taken) => `+${added} −${taken}`,
		line: { old: 'Rad innan', new: 'Rad efter', sign: 'Tecken', text: 'Text' },
		added: 'tillagd',
		taken: 'borttagen',
		skipped: (n) => `${count(n, 'rad', 'rader')} likadana`,
		noNewline: 'ingen ny rad på slutet',
		all: (n) => `Visa alla ${n} rader`,
		more: (n) => `Visa alla ${n}`
	},

	dialog: {
		title: 'Driftsätt utkastet',
		titleOf: (name) => `Driftsätt ”${name}”`,
		needs: 'Vad som behövs',
		met: 'klart',
		missing: 'saknas',
		need: {
			saved: 'Utkastet är sparat som revision.',
			other: 'Det är ett annat än det som körs.',
			checked: 'Det är granskat, utan fel och med övervakare.',
			standing: 'Inget startar av sig självt: stationen är pausad, stannad, i omstart eller väntar på start, och ingen plan av en person är på väg.',
			control: 'Du har kontrollen.',
			fits: 'Stationens tillstånd är säkert i den nya modellen, och det som ännu pågår är detsamma där.'
		},
		fitsReset: 'Tillståndet som simuleringen börjar i är säkert i den nya modellen.',
		differs: 'Se vad som skiljer',
		stillRuns: 'Det som började pågår ännu och får bli klart:',
		errand: 'En plan av en person är på väg: stoppa det på Omstart, eller vänta tills det är klart.',
		toRestart: 'Till Omstart',
		fit: {
			later: 'Det undersöks när utkastet är granskat.',
			asking: 'Det undersöks. Det tar några sekunder.',
			again: 'Undersök igen',
			moved: 'Stationen eller utkastet har ändrats sedan dess.',
			violated: 'I sitt nuvarande tillstånd skulle den bryta mot',
			underWay: 'Av det som ännu pågår är detta ett annat i den nya modellen. Vänta tills det är klart:',
			noRest: 'Från det nuvarande tillståndet skulle inget kunna komma till vila där.',
			ways: 'Vägar in i de säkra tillstånden:',
			noWay: 'Ingen väg in i de säkra tillstånden är känd. För enheterna till ett annat tillstånd, eller ändra modellen.',
			obstacle: 'Det går inte att veta:'
		},
		changes: 'Vad som inte fortsätter som det är',
		goesOn: 'Alla variabler fortsätter som de är.',
		change: {
			new: 'ny',
			gone: 'borta',
			anew: 'börjar om'
		},
		to: (before, after) => `${before} → ${after}`,
		begins: (value) => `börjar som ${value}`,
		was: (value) => `var ${value}`,
		means: {
			keep: 'Styrningen startar om med denna modell. Det som antogs kommer tillbaka så långt det passar, inget sänds till enheter, och en person startar produktionen. Du behåller kontrollen. Om modellen inte kan startas kommer den tidigare tillbaka.',
			reset:
				'Styrningen startar om med denna modell, och allt börjar som modellen säger: det som körs nu fortsätter inte. Inget sänds till enheter, och en person startar produktionen. Du behåller kontrollen. Om modellen inte kan startas kommer den tidigare tillbaka.'
		},
		simulation: {
			title: 'Emulerade enheter',
			keep: 'De fortsätter som de står.',
			reset: 'Återställ simuleringen: enheter, utgångar och antaganden börjar som modellen säger.'
		},
		sure: (name) => `Jag vill att ”${name}” tar platsen för det som körs.`,
		confirm: 'Bekräfta att du vill det.',
		missingStill: (n) => `${count(n, 'sak', 'saker')} saknas.`,
		word: 'Driftsätt'
	},

	progress: {
		title: (name) => `”${name}” driftsätts`,
		titleRuns: (name) => `”${name}” körs`,
		steps: {
			sent: 'Skickad',
			accepted: 'Mottagen: filerna är på plats',
			anew: 'Styrningen börjar om',
			runs: 'Stationen kör den'
		},
		is: { done: 'klart', now: 'nu', later: 'återstår' },
		titleUndone: (name) => `”${name}” kunde inte startas`,
		late: 'Det tar längre tid än vanligt. Vad servern skriver ut säger varför.',
		next: 'Inget sänds till enheter än: starta produktionen på Drift.',
		undone: 'Den tidigare modellen är tillbaka, och utkastet är som du driftsatte det: ändra det och driftsätt igen, eller starta produktionen som förut.',
		close: 'Lägg undan'
	}
};
