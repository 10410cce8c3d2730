import { withinSentence } from '../../wording/capital.ts';
import type { Text } from '../text.svelte.ts';

export const ros: Text['ros'] = {
	title: 'ROS-nätverk',
	noGraph: 'Nätet har inte lästs än.',
	read: (age) => `Nätet lästes ${age}.`,
	readOld: (age) => `Inte direkt. Det som visas är gammalt: läst ${age}.`,
	ago: (age) => `för ${age} sedan`,
	before: (age) => `${age} innan`,
	justNow: 'nyss',
	days: (n) => `${n} dygn`,
	well: (n) => (n === 1 ? 'Stationens enda topic är i ordning.' : `Stationens alla ${n} topics är i ordning.`),
	station: 'Stationen',
	unnamed: 'en nod utan namn',
	nobody: 'ingen',
	you: (name) => `${name} (den här stationen)`,
	trouble: 'Vad som är fel',
	more: (n) => `${n} till`,
	standing: {
		fresh: 'färsk',
		stale: 'för gammal',
		gone: 'tyst',
		unheard: 'tyst',
		absent: 'tyst',
		mismatch: 'inte överens',
		trouble: 'fel',
		met: 'ansluten',
		unmet: 'ingen lyssnar',
		foreign: 'inte stationens'
	},
	wrong: {
		stale: (resources) => `Inget meddelande på längre tid än gränsen: ${resources}`,
		gone: (resources) => `Tyst, eftersom sändaren är borta: ${resources}`,
		unheard: (resources) => `Tyst, fast en sändare finns: ${resources}`,
		absent: (resources) => `Tyst, eftersom ingen sänder: ${resources}`,
		trouble: (resources) => `Fel på det som går fram: ${resources}`,
		unmet: (resources) => `Ingen tar emot det som sänds till: ${resources}`
	},
	remedy: {
		stale: (nodes) => `Se till ${nodes} och nätet däremellan.`,
		gone: 'Se efter om noden är i gång och kan nås, och starta den igen.',
		unheard: (nodes) => `Se till ${nodes}: finns på nätet men sänder inget.`,
		absent: 'Starta noden. Är den i gång, jämför dess ROS_DOMAIN_ID, nät och namn på topics med stationens.',
		trouble: (nodes) => `Se till ${nodes}.`,
		unmet: 'Starta noden. Är den i gång, jämför dess ROS_DOMAIN_ID, nät och namn på topics med stationens.'
	},
	mismatch: {
		type: 'En annan typ',
		definition: 'En annan definition av typen',
		quality: 'Tjänstekvaliteten (QoS) stämmer inte',
		rival: 'Två skriver samma kommando',
		ours: 'Stationen',
		theirs: 'Den andra',
		node: 'Nod',
		topic: 'Topic',
		remedy: {
			type: 'Rätta typen i modellen, eller låt noden använda modellens typ.',
			definition: 'Bygg noden och stationen från samma meddelandefiler: det som går mellan dem nu skulle bli förvanskat.',
			quality: 'Rätta kvaliteten i modellen, eller låt noden inte begära mer än den andra sidan erbjuder.',
			rival: 'Stoppa den andra, eller den här stationen. Inget startas under tiden.'
		},
		policy: {
			reliability: 'tillförlitlighet',
			durability: 'varaktighet',
			deadline: 'tidsgräns',
			liveliness: 'livstecken'
		}
	},
	filter: {
		label: 'Vad som visas',
		search: 'Sök: topic, typ eller nod',
		resource: 'Resurs',
		show: 'Visa',
		all: 'allt',
		ofStation: 'stationens topics',
		wrong: 'vad som är fel'
	},
	lists: {
		label: 'Vad som listas',
		topics: (n) => `Topics (${n})`,
		nodes: (n) => `Noder (${n})`,
		services: (n) => `Services (${n})`,
		actions: (n) => `Actions (${n})`
	},
	column: {
		topic: 'Topic',
		resource: 'Resurs',
		standing: 'Tillstånd',
		rate: 'Takt',
		last: 'Senaste meddelandet',
		messages: 'Meddelanden',
		publishers: 'Sändare',
		subscribers: 'Mottagare',
		quality: 'Tjänstekvalitet (QoS)',
		node: 'Nod',
		vendor: 'Gjord av',
		publishes: 'Sänder',
		subscribes: 'Tar emot',
		serves: 'Svarar på',
		name: 'Namn',
		type: 'Typ',
		servers: 'Besvaras av',
		clients: 'Frågas av',
		hash: 'Definitionens hash'
	},
	caption: { topics: 'Topics', nodes: 'Noder', services: 'Services', actions: 'Actions' },
	empty: { topics: 'Ingen sådan topic', nodes: 'Ingen sådan nod', services: 'Inga', actions: 'Inga' },
	servicesUnknown: 'Stationens transport kan inte tala om vilka services som finns.',
	direction: { in: 'från', out: 'till' },
	rate: (perSecond) => `${perSecond}/s`,
	never: 'aldrig',
	ofDeadline: (age, deadline) => `${age}, gräns ${deadline}`,
	chosen: {
		pipeline: 'Visa dess pipeline',
		topic: (name) => `Topic ${name}`,
		resource: (title) => `Topics för ${withinSentence(title)}`,
		unknown: (name) => `Varken någon på nätet eller stationen känner till en topic ${name}.`,
		close: 'Visa alla topics',
		state: (title) => `Tillstånd för ${title}`,
		all: (title) => `Alla topics för ${title}`,
		counted: (n) => `${n} sedan styrningen startades`,
		ends: 'Sändare och mottagare',
		end: 'Vad den gör',
		publishes: 'sänder',
		subscribes: 'tar emot',
		none: 'Ingen sänder den och ingen tar emot den.',
		picture: 'Vem talar med vem'
	},
	picture: {
		publishers: 'Sändare',
		topics: 'Topics',
		subscribers: 'Mottagare',
		same: 'Tabellerna på sidan säger detsamma.'
	},
	quality: {
		reliable: 'tillförlitlig (reliable)',
		best_effort: 'i mån av möjlighet (best effort)',
		volatile: 'flyktig (volatile)',
		transient_local: 'bevaras (transient local)',
		deadline: (seconds) => `tidsgräns ${seconds}`,
		liveliness: (seconds) => `livstecken ${seconds}`
	}
};
