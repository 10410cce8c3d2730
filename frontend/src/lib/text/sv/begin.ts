import { count } from '../count.ts';
import type { Text } from '../text.svelte.ts';

export const begin: Text['begin'] = {
	title: 'Första stationen',
	kept: 'Behålls i den här webbläsaren.',
	tabs: {
		split: 'Den här stationen skrivs också i en annan flik, och båda har sagt något annat sedan dess. Inget är förlorat: välj vilken av dem som gäller.',
		there: 'Fortsätt med den andra fliken',
		here: 'Fortsätt med det som står här',
		follows: 'En annan flik har gått vidare med stationen: dess svar står här nu.'
	},
	stepsLabel: 'Steg',
	choose: 'Välj …',
	steps: { station: 'Station', devices: 'Enheter', poses: 'Lägen', product: 'Produkt', never: 'Aldrig', look: 'Titta och börja' },
	about: {
		station: 'Vad stationen heter, och vad du börjar med.',
		devices: 'Det som kan göra något här: robotar, verktyg, fixturer, dörrar och människor.',
		poses: 'Vart varje robot kan skickas. Den vilar i det första läget.',
		product: 'Vad som tillverkas, och vad som för det från ett tillstånd till nästa.',
		never: 'Vad som aldrig får vara. Det ser stationen till själv.',
		look: 'Läs vad du har sagt och lägg det sedan i utkastet.'
	},
	toRight: (n) => count(n, 'sak att rätta', 'saker att rätta'),
	back: (step) => `Tillbaka: ${step}`,
	next: (step) => `Nästa: ${step}`,
	startOver: 'Börja om…',
	startOverTitle: 'Börja om?',
	startOverMeans: 'Allt du har skrivit här går förlorat. Utkastet är kvar som det är.',
	startOverDo: 'Börja om',
	blank: '…',
	notNumbers: 'Skriv tal med komma emellan, högst 32.',
	notChosen: 'Välj en.',
	most: (n) => `Högst ${n}.`,
	field: {
		title: 'Titel',
		name: 'Namn',
		titleOf: (what) => `Titel: ${what}`,
		nameOf: (what) => `Namn: ${what}`
	},
	row: {
		up: (what) => `Flytta upp: ${what}`,
		down: (what) => `Flytta ner: ${what}`,
		remove: (what) => `Ta bort: ${what}`
	},
	station: {
		title: 'Stationens titel',
		beginWith: 'Börja med',
		cards: {
			bolt: { title: 'En bult dras åt', about: 'En operatör sätter i en bult, en robot för skruvdragaren som drar åt den. Visar en människa och en robot på samma plats.' },
			'pick-and-place': { title: 'En del plockas och placeras', about: 'En robot med gripdon flyttar en del till en fixtur bakom en dörr. Visar lägen, ett gripdon och en dörr.' },
			'person-and-clamp': { title: 'En människa och en fixtur', about: 'En människa lägger i en del, och en fixtur håller den åt ett verktyg. Visar en station utan robot.' }
		},
		nothing: 'Ingenting',
		nothingAbout: 'Du säger allt själv.',
		replaceTitle: 'Ersätta det du har skrivit?',
		replaceMeans: 'Enheter, lägen, produkten och det som aldrig får vara ersätts. Titeln är kvar, om du har skrivit en.',
		replace: 'Ersätt det'
	},
	devices: {
		library: 'Bibliotek',
		kinds: { robot: 'Robot med namngivna lägen', tool: 'Verktyg som går tills det är klart', clamp: 'Fixtur, gripdon eller dörr', person: 'Människa med klocka', found: 'Enhet på nätet' },
		about: {
			robot: 'Den skickas till lägen.',
			tool: 'En skruvdragare, en limpistol.',
			clamp: 'Den öppnar och stänger, och vilar öppen.',
			person: 'Uppgifter begärs och kvitteras.'
		},
		short: { robot: 'Robot', tool: 'Verktyg', clamp: 'Fixtur', person: 'Operatör' },
		firstPose: 'Hemma',
		added: 'Stationens enheter',
		none: 'Ingen enhet än. Tryck på en i biblioteket.',
		network: {
			title: 'Från nätet',
			about: 'De här noderna finns på nätet nu. En enhet får nodens topics; dess förmågor skriver du senare, i Modell.',
			reading: 'Nätet läses.',
			nothing: 'Inget hörs på nätet: inga noder utom stationens egna. Starta enhetens nod med samma ROS_DOMAIN_ID.',
			unnamed: 'en nod utan namn',
			device: 'Enhet',
			topics: (n) => count(n, 'topic', 'topics'),
			add: 'Lägg till',
			addNode: (node) => `Lägg till: ${node}`,
			chosen: (device, n) => `Topics för ${device}: ${n} valda`,
			gone: 'Inte på nätet nu'
		}
	},
	poses: {
		none: 'Stationen har ingen robot: här finns inget att göra.',
		about: 'Leder i rad eller m, som 0.5, -1.57: lika många i varje läge. Utelämna dem där roboten själv kan sina lägen vid namn.',
		waysOf: 'Mellan vilka lägen den går',
		ways: { any: 'Hur som helst', row: 'Längs den här raden' },
		joints: 'Ledvinklar',
		jointsOf: (pose) => `Ledvinklar: ${pose}`,
		pose: (n) => `Läge ${n}`,
		add: 'Lägg till ett läge',
		srdf: {
			open: 'Importera från SRDF…',
			title: 'Importera från SRDF',
			about: 'Namngivna lägen från MoveIt. Ett läge med samma namn får lederna som står där.',
			file: 'Fil',
			text: 'Eller dess text',
			noFile: (name) => `${name} kan inte läsas.`,
			xml: (line) => `Det här är ingen XML: rad ${line} kan inte läsas.`,
			unread: {
				entities: 'Det här har en dokumenttyp eller egna entiteter, som inte läses. Ta bort dem.',
				none: 'Det här har inga lägen: inget som <group_state name="home" group="arm">.',
				long: 'Det här är längre än 5 miljoner tecken.'
			},
			group: (name, n) => `${name || 'Ingen grupp'}: ${count(n, 'läge', 'lägen')}`,
			joints: (names) => `Leder i den här ordningen: ${names}`,
			tickAll: 'Välj alla',
			tickAllOf: (group) => `Välj alla: ${group}`,
			more: (n) => `${n} till visas inte: utelämna det du inte behöver ur texten.`,
			wrong: {
				name: () => 'Det har inget namn.',
				number: (joint) => `Leden ${joint || 'utan namn'} har inget tal.`,
				missing: (joint) => `Leden ${joint} saknas.`,
				other: (joint) => `Det första läget har inte leden ${joint}.`
			},
			tooMany: (room) => `Det finns plats för ${room} till.`,
			bring: (n) => (n === 0 ? 'Importera' : `Importera ${count(n, 'läge', 'lägen')}`)
		}
	},
	product: {
		states: 'Dess tillstånd, i ordning',
		calledBy: (name, operation) => `Flera steg heter ${name}: i dokumenten heter operationen för det här ${operation}.`,
		none: 'Inget tillstånd än. Börja med hur den kommer: saknas, rå, i lådan.',
		state: (n) => `Tillstånd ${n}`,
		add: 'Lägg till ett tillstånd',
		between: (from, to) => `Från ${from} till ${to}`,
		by: 'Vem som gör det',
		nobody: 'Ingen enhet kan göra det än. Lägg till en under Enheter: en robot ensam åstadkommer inget, det den bär gör det.',
		action: 'Vad den gör',
		actions: { close: 'stänger', open: 'öppnar' },
		robot: 'Robot',
		pose: 'Står i läget',
		addStand: 'En robot står i ett läge under tiden',
		removeStand: 'Ta bort: var roboten står',
		then: 'När den är klar',
		thens: { next: 'Nästa kommer av sig själv', order: 'Nästa kommer med en order, när stationen arbetar efter order', once: 'Inget följer' }
	},
	never: {
		nothing: 'Säg först vilka enheter som finns och vad som tillverkas.',
		none: 'Inget än. Säg vad som vore farligt, eller skulle förstöra något.',
		rule: (n) => `Regel ${n}`,
		group: (rule, label) => `Regel ${rule}: ${label}`,
		never: 'Aldrig',
		while: 'medan',
		and: 'och',
		thing: 'Vad det gäller',
		way: 'Är eller är inte',
		is: 'är',
		isNot: 'är inte',
		value: 'Vad det kan vara',
		removeFact: 'Ta bort: den här delen',
		addAnd: 'och',
		addWhile: 'medan',
		add: 'Lägg till en regel',
		suggested: 'Förslag',
		take: 'Lägg till',
		takeIt: (text) => `Lägg till: ${text}`,
		called: (title) => `Den heter ”${title}”.`,
		uncall: 'Kalla den som den läses'
	},
	values: { running: 'i gång', idle: 'stilla', open: 'öppen', closed: 'stängd', busy: 'upptagen', free: 'ledig', under_way: 'på gång' },
	documents: {
		title: 'Dokument',
		label: 'Dokument',
		notYet: 'Dokumenten finns här så snart inget saknas.',
		missing: 'Kvar att rätta',
		old: 'Som det var förut. Något är kvar att rätta.'
	},
	sentence: {
		station: (title) => `Stationen heter ”${title}”.`,
		robot: (title, poses, row) =>
			poses === '' ? `${title} har inget läge än.` : row ? `${title} går längs en rad: ${poses}.` : `${title} går mellan ${poses}, hur som helst.`,
		arm: (title) => `${title} går till namngivna lägen.`,
		tool: (title) => `${title} går tills det är klart.`,
		clamp: (title) => `${title} öppnar och stänger.`,
		person: (title) => `${title} får uppgifter på en klocka.`,
		found: (title, n) => `${title} finns på nätet, med ${count(n, 'topic', 'topics')}.`,
		first: (product, state) => `Från början är ${product} ${state}.`,
		step: (step, by, from, to, how) => `${step}: ${by} för den från ${from} till ${to}${how}.`,
		how: { close: ' genom att stänga', open: ' genom att öppna' },
		stands: (robot, pose) => `${robot} är i läget ”${pose}”`,
		meanwhile: (done, where) => `${done} Under tiden: ${where}.`,
		then: {
			next: (product) => `När ${product} är klar kommer nästa av sig själv.`,
			order: (product) => `När ${product} är klar kommer nästa med en order. Tryck för det på På order på sidan Order.`,
			once: (product) => `När ${product} är klar följer inget.`
		},
		fact: (thing, value, holds) => `${thing} ${holds ? '' : 'inte '}${value}`,
		during: (thing, value, holds) => `${thing} ${holds ? 'är' : 'inte är'} ${value}`,
		inPose: (pose) => `i läget ”${pose}”`,
		never: (facts, during) => `Aldrig ${facts}${during === null ? '' : ` medan ${during}`}`
	},
	put: {
		said: 'Vad du har sagt',
		nothing: 'Inget är sagt än. Börja med Station.',
		errors: 'Dokumenten kan inte användas som de är',
		do: 'Lägg det i utkastet',
		next: 'Det öppnas i Modell: se vad kontrollen hittar, prova i simulering, granska sedan ändringarna. Det som körs fortsätter som det är tills du driftsätter.',
		wrong: (n) => `Inte än: ${count(n, 'sak är', 'saker är')} kvar att rätta.`,
		asking: 'Dokumenten görs.',
		unknown: 'Servern kan inte nås. Det du har skrivit behålls här.',
		replaceTitle: 'Ersätta det som är i utkastet?',
		replaceMeans: 'Utkastet har mer än sitt namn. Det är en ändring, som Ångra tar tillbaka.',
		replaced: 'Skrivs annorlunda:',
		removed: 'Tas bort:',
		replace: 'Ersätt utkastet',
		change: (title) => (title === '' ? 'Stationen gjord steg för steg' : `Stationen ”${title}” gjord steg för steg`),
		attaching: (topic, of) => `Topic ${topic} av ${of} tas in.`,
		notMade: 'Modellen kan inte ta in den.'
	},
	begun: {
		title: 'Vad som kommer sedan',
		next: 'Stationen är i utkastet. Sedan:',
		check: 'Se vad kontrollen hittar',
		failed: 'De här topics kunde inte tas in:'
	},
	empty: {
		title: 'Den här stationen är tom',
		about: 'Svara på några frågor och få en station som kan kontrolleras och provas, eller skriv varje del själv.',
		steps: 'Bygg den steg för steg',
		part: 'Börja med en tom del…'
	},
	tool: 'Steg för steg'
};
