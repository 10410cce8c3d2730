/** Sidan som visar operationerna i deras ordning. */
import { count } from '../count.ts';
import { withinSentence } from '../../wording/capital.ts';
import type { Text } from '../text.svelte.ts';

export const sequence: Text['sequence'] = {
	loading: 'Operationerna läses.',
	label: 'Operationer i deras ordning',
	keys: 'Piltangenterna leder till nästa operation i den riktningen, Home och End till den första och den sista. Enter leder till det som sägs om den, Escape tillbaka.',
	view: 'Visas som',
	views: { sequence: 'Ordning', time: 'Gantt', table: 'Tabell' },
	said: (n, masters) =>
		masters.length === 0 ? count(n, 'operation', 'operationer') : `${count(n, 'operation', 'operationer')} · ${masters.join(', ')}`,
	add: 'Operation',
	unusable: 'Utkastet kan inte användas som det är. Det här är ordningen som den var tidigare; den kan inte redigeras här förrän det är rättat.',
	toModel: 'Till problemen',
	none: 'Det finns inga operationer',
	noneHow: 'En operation säger vad som ska uppnås och när det är önskat. Lägg till en på sidan Modell, i operations.yaml.',
	chosen: 'Den valda operationen',
	noLane: 'Stationen',
	by: (lane) => `Görs av ${withinSentence(lane)}`,
	isNew: 'finns inte i stationen än',
	ofDraft: 'utkast',
	took: (time) => `tog ${time}`,
	tookLast: (time) => `Tog ${time} senast`,
	inModel: (file, line) => `${file}, rad ${line}`,
	begins: 'Börjar när',
	turns: 'Dess tur, enligt sekvenser',
	ends: 'Är klar när',
	always: 'Alltid.',
	plan: 'Så gör planen det',
	conditions: { so: 'gäller', not: 'gäller inte', open: 'inte känt', expression: 'Som uttryck' },
	order: {
		before: 'Kommer efter',
		after: 'Kommer före',
		noneBefore: 'Inget måste göras först.',
		noneAfter: 'Inget väntar på den.',
		again: 'från förra varvet',
		chance: 'en av flera räcker',
		bySequence: (name) => `sekvensen ${name}`,
		byMaster: (title) => `arbetsmallen ”${title}”`,
		itself: 'En operation kan inte komma efter sig själv.',
		already: (before, after) => `”${after}” kommer redan efter ”${before}”.`,
		circle: (before, after) => `”${before}” kommer redan före ”${after}”: med en pil tillbaka kunde ingen av dem börja.`,
		drawn: (before, after) => `I utkastet kommer ”${after}” nu efter ”${before}”`,
		erased: (before, after) => `I utkastet kommer ”${after}” inte längre efter ”${before}”`,
		inModel: 'Ändra det på Modell',
		seeInModel: 'Se det på Modell',
		erase: (before, after) => `Ta bort: ”${after}” kommer efter ”${before}”`,
		putBehind: 'Låt den komma efter',
		put: 'Lägg till',
		how: 'Det som redan kommer efter den erbjuds inte. Eller dra en pil i bilden, från punkten till höger om en operation till en annan. Den skrivs som en sekvens i operations.yaml och gäller efter en driftsättning.'
	},
	together: {
		title: 'Tillsammans med andra',
		kinds: { sequence: 'I följd', parallel: 'Samtidigt', arbitrary: 'Valfri ordning', alternative: 'En av dem' },
		how: {
			sequence: 'En efter en, som de är numrerade',
			parallel: 'Alla; ingen väntar på någon annan',
			arbitrary: 'Alla, en i taget; som de är numrerade där flera kan börja',
			alternative: 'Bara en av dem: den första, som de är numrerade, som kan börja'
		},
		of: (kind, titles) => `${kind}: ${titles.join(', ')}`,
		bar: 'Lägg ihop dem',
		more: 'En utvald. Skift och ett tryck, eller Skift och mellanslag, tar med en till',
		picked: (n) => `${n} utvalda`,
		isPicked: ', utvald',
		none: 'Ta inte med någon',
		keys: 'Skift och mellanslag väljer ut flera, för att lägga ihop dem.',
		ordered: (before, after) => `”${after}” väntar redan på ”${before}”. Ta bort den ordningen först: då kan de läggas ihop på annat sätt.`,
		already: (kind, name) => `Några av dem är redan ihoplagda, i ”${name}”: ${kind}. Ändra det där, på Modell.`,
		written: (kind, titles) => `I utkastet nu ${kind.toLowerCase()}: ${titles.join(', ')}`
	},
	time: {
		none: 'Inget pågår',
		noneHow: 'Så snart en operation är aktiv visas här när den började och när den väntas vara klar.',
		bar: (title, standing, worked, waited) => `${title}: ${standing}, ${worked} arbete, ${waited} väntan`,
		legend: 'Vad som ritas hur',
		tones: { past: 'Utfört arbete', run: 'Pågående arbete', plan: 'Planerat arbete', wait: 'Väntar', fail: 'Har stannat' }
	},
	table: { operation: 'Operation', by: 'Görs av', standing: 'Nu', took: 'Senast', oneOf: (names) => (names.length === 1 ? (names[0] ?? '') : `en av: ${names.join(', ')}`) }
};
