/** The ROS graph. */
export const ros = {
	title: 'ROS network',
	noGraph: 'The network has not been read yet.',
	read: (age: string): string => `Network read ${age}.`,
	readOld: (age: string): string => `Not live. What is shown is old: read ${age}.`,
	ago: (age: string): string => `${age} ago`,
	before: (age: string): string => `${age} before`,
	justNow: 'just now',
	days: (n: number): string => `${n} days`,
	well: (n: number): string =>
		n === 1 ? 'The one topic of the station is in order.' : `All ${n} topics of the station are in order.`,
	station: 'The station',
	unnamed: 'a node without a name',
	nobody: 'nobody',
	you: (name: string): string => `${name} (this station)`,
	trouble: 'What is wrong',
	more: (n: number): string => `${n} more`,
	standing: {
		fresh: 'fresh',
		stale: 'stale',
		gone: 'silent',
		unheard: 'silent',
		absent: 'silent',
		mismatch: 'not agreed',
		trouble: 'trouble',
		met: 'connected',
		unmet: 'nobody listens',
		foreign: 'not of the station'
	},
	wrong: {
		stale: (resources: string): string => `No message for longer than the deadline: ${resources}`,
		gone: (resources: string): string => `Silent, as the publisher has gone: ${resources}`,
		unheard: (resources: string): string => `Silent, though a publisher is there: ${resources}`,
		absent: (resources: string): string => `Silent, as nobody publishes: ${resources}`,
		trouble: (resources: string): string => `What passes makes trouble: ${resources}`,
		unmet: (resources: string): string => `Nobody listens to what is sent to: ${resources}`
	},
	remedy: {
		stale: (nodes: string): string => `Look after ${nodes}, and after the network between.`,
		gone: 'See whether its node runs and is reachable, and start it again.',
		unheard: (nodes: string): string => `Look after ${nodes}: on the network, and sends nothing.`,
		absent:
			'Start the node. If it runs, compare its ROS_DOMAIN_ID, its network and the names of its topics with those of the station.',
		trouble: (nodes: string): string => `Look after ${nodes}.`,
		unmet:
			'Start the node. If it runs, compare its ROS_DOMAIN_ID, its network and the names of its topics with those of the station.'
	},
	mismatch: {
		type: 'Another type',
		definition: 'Another definition of the type',
		quality: 'Quality of service is not agreed on',
		rival: 'Two writers of one command',
		ours: 'The station',
		theirs: 'The other one',
		node: 'Node',
		topic: 'Topic',
		remedy: {
			type: 'Correct the type in the model, or have the node use the one of the model.',
			definition:
				'Build the node and the station from the same message files: whatever passes now would be garbled.',
			quality: 'Correct the quality in the model, or have the node ask for no more than the other side offers.',
			rival: 'Stop the other one, or this station. Nothing is started meanwhile.'
		},
		policy: {
			reliability: 'reliability',
			durability: 'durability',
			deadline: 'deadline',
			liveliness: 'liveliness'
		}
	},
	filter: {
		label: 'What is shown',
		search: 'Search: topic, type or node',
		resource: 'Resource',
		show: 'Show',
		all: 'everything',
		ofStation: 'topics of the station',
		wrong: 'what is wrong'
	},
	lists: {
		label: 'What is listed',
		topics: (n: number): string => `Topics (${n})`,
		nodes: (n: number): string => `Nodes (${n})`,
		services: (n: number): string => `Services (${n})`,
		actions: (n: number): string => `Actions (${n})`
	},
	column: {
		topic: 'Topic',
		resource: 'Resource',
		standing: 'State',
		rate: 'Rate',
		last: 'Last message',
		messages: 'Messages',
		publishers: 'Publishers',
		subscribers: 'Subscribers',
		quality: 'Quality of service',
		node: 'Node',
		vendor: 'Made by',
		publishes: 'Publishes',
		subscribes: 'Subscribes',
		serves: 'Serves',
		name: 'Name',
		type: 'Type',
		servers: 'Answered by',
		clients: 'Asked by',
		hash: 'Hash of the definition'
	},
	caption: { topics: 'Topics', nodes: 'Nodes', services: 'Services', actions: 'Actions' },
	empty: { topics: 'No such topic', nodes: 'No such node', services: 'None', actions: 'None' },
	servicesUnknown: 'The transport of the station cannot tell services.',
	direction: { in: 'from', out: 'to' },
	rate: (perSecond: string): string => `${perSecond}/s`,
	never: 'never',
	ofDeadline: (age: string, deadline: string): string => `${age}, deadline ${deadline}`,
	chosen: {
		pipeline: 'Show its pipeline',
		topic: (name: string): string => `Topic ${name}`,
		resource: (title: string): string => `Topics of ${title}`,
		unknown: (name: string): string => `Nobody on the network, and not the station, knows a topic ${name}.`,
		close: 'Show all topics',
		state: (title: string): string => `State of ${title}`,
		all: (title: string): string => `All topics of ${title}`,
		counted: (n: number): string => `${n} since the controller was started`,
		ends: 'Publishers and subscribers',
		end: 'What it does',
		publishes: 'publishes',
		subscribes: 'subscribes',
		none: 'Nobody publishes it, and nobody subscribes.',
		picture: 'Who speaks to whom'
	},
	picture: {
		publishers: 'Publishers',
		topics: 'Topics',
		subscribers: 'Subscribers',
		same: 'The tables on this page say the same.'
	},
	quality: {
		reliable: 'reliable',
		best_effort: 'best effort',
		volatile: 'volatile',
		transient_local: 'transient local',
		deadline: (seconds: string): string => `deadline ${seconds}`,
		liveliness: (seconds: string): string => `liveliness ${seconds}`
	}
};
