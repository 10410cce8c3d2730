import { count } from '../count.ts';

/** First station: few answers become the documents of a station. */
export const begin = {
	title: 'First station',
	kept: 'Kept in this browser.',
	tabs: {
		split: 'This station is also written in another tab, and both have said something else since. Nothing is lost: choose which of both goes on.',
		there: 'Go on with the other tab',
		here: 'Go on with what is here',
		follows: 'Another tab has gone on with this station: its answers are here now.'
	},
	stepsLabel: 'Steps',
	choose: 'Choose…',
	steps: { station: 'Station', devices: 'Devices', poses: 'Poses', product: 'Product', never: 'Never', look: 'Look and begin' },
	about: {
		station: 'What the station is called, and what you begin with.',
		devices: 'What can do something here: robots, tools, clamps, doors and people.',
		poses: 'Where each robot can be sent. It rests in the first pose.',
		product: 'What is made, and what brings it from one state to the next.',
		never: 'What must never be. The station keeps it by itself.',
		look: 'Read what you said, then put it into the draft.'
	},
	toRight: (n: number): string => count(n, 'thing to put right', 'things to put right'),
	back: (step: string): string => `Back: ${step}`,
	next: (step: string): string => `Next: ${step}`,
	startOver: 'Start over…',
	startOverTitle: 'Start over?',
	startOverMeans: 'All that you wrote here is lost. The draft stays as it is.',
	startOverDo: 'Start over',
	/** In the place of what was not chosen yet. */
	blank: '…',
	notNumbers: 'Write numbers with commas between, 32 at most.',
	notChosen: 'Choose one.',
	most: (n: number): string => `${n} at most.`,
	field: {
		title: 'Title',
		name: 'Name',
		titleOf: (what: string): string => `Title: ${what}`,
		nameOf: (what: string): string => `Name: ${what}`
	},
	row: {
		up: (what: string): string => `Move up: ${what}`,
		down: (what: string): string => `Move down: ${what}`,
		remove: (what: string): string => `Take away: ${what}`
	},
	station: {
		title: 'Title of the station',
		beginWith: 'Begin with',
		cards: {
			bolt: { title: 'A bolt is tightened', about: 'An operator places a bolt, a robot guides the nutrunner that tightens it. Shows a person and a robot at one place.' },
			'pick-and-place': { title: 'A part is picked and placed', about: 'A robot with a gripper moves a part into a fixture behind a door. Shows poses, a gripper and a door.' },
			'person-and-clamp': { title: 'A person and a clamp', about: 'A person puts a part in, and a clamp holds it for a tool. Shows a station without a robot.' }
		},
		nothing: 'Nothing',
		nothingAbout: 'You say all of it yourself.',
		replaceTitle: 'Take the place of what you wrote?',
		replaceMeans: 'Devices, poses, the product and what must never be are replaced. The title stays, if you wrote one.',
		replace: 'Replace it'
	},
	devices: {
		library: 'Library',
		kinds: { robot: 'Robot with named poses', tool: 'Tool that runs until it is done', clamp: 'Clamp, gripper or door', person: 'Person with a watch', found: 'Device on the network' },
		about: {
			robot: 'It is sent to poses.',
			tool: 'A nutrunner, a glue gun, a screwdriver.',
			clamp: 'It opens and closes, and rests open.',
			person: 'Tasks are asked for and acknowledged.'
		},
		short: { robot: 'Robot', tool: 'Tool', clamp: 'Clamp', person: 'Operator' },
		firstPose: 'Home',
		added: 'Devices of the station',
		none: 'No device yet. Press one of the library.',
		network: {
			title: 'From the network',
			about: 'These nodes are on the network now. A device of one gets its topics; its abilities you write later, in Model.',
			reading: 'The network is being read.',
			nothing: 'Nothing is heard on the network: no node but those of this station. Start the node of the device with the same ROS_DOMAIN_ID.',
			unnamed: 'a node without a name',
			device: 'Device',
			topics: (n: number): string => count(n, 'topic', 'topics'),
			add: 'Add',
			addNode: (node: string): string => `Add: ${node}`,
			chosen: (device: string, n: number): string => `Topics of ${device}: ${n} ticked`,
			gone: 'Not on the network now'
		}
	},
	poses: {
		none: 'The station has no robot: there is nothing to do here.',
		about: 'Joints in rad or m, such as 0.5, -1.57: as many in each pose. Leave them out where the robot knows its poses by their names.',
		waysOf: 'Between which poses it goes',
		ways: { any: 'Any way', row: 'Along this row' },
		joints: 'Joint angles',
		jointsOf: (pose: string): string => `Joint angles: ${pose}`,
		pose: (n: number): string => `Pose ${n}`,
		add: 'Add a pose',
		srdf: {
			open: 'Import from SRDF…',
			title: 'Import from SRDF',
			about: 'Named poses of MoveIt. A pose of the same name gets the joints that are written there.',
			file: 'File',
			text: 'Or its text',
			noFile: (name: string): string => `${name} cannot be read.`,
			xml: (line: number): string => `This is no XML: line ${line} cannot be read.`,
			unread: {
				entities: 'This has a document type or entities of its own, which are not read. Take them out.',
				none: 'This has no group states: nothing like <group_state name="home" group="arm">.',
				long: 'This is longer than 5 million letters.'
			},
			group: (name: string, n: number): string => `${name || 'No group'}: ${count(n, 'pose', 'poses')}`,
			joints: (names: string): string => `Joints in this order: ${names}`,
			tickAll: 'Tick all',
			tickAllOf: (group: string): string => `Tick all: ${group}`,
			more: (n: number): string => `${n} more are not shown: leave out of the text what you do not need.`,
			wrong: {
				name: (_: string): string => 'It has no name.',
				number: (joint: string): string => `The joint ${joint || 'without a name'} has no number.`,
				missing: (joint: string): string => `The joint ${joint} is missing.`,
				other: (joint: string): string => `The first pose does not have the joint ${joint}.`
			},
			tooMany: (room: number): string => `There is room for ${room} more.`,
			bring: (n: number): string => (n === 0 ? 'Import' : `Import ${count(n, 'pose', 'poses')}`)
		}
	},
	product: {
		states: 'Its states, in order',
		calledBy: (name: string, operation: string): string => `Several steps are called ${name}: in the documents the operation of this one is called ${operation}.`,
		none: 'No state yet. Begin with how it comes: missing, raw, in the tray.',
		state: (n: number): string => `State ${n}`,
		add: 'Add a state',
		between: (from: string, to: string): string => `From ${from} to ${to}`,
		by: 'Who does it',
		nobody: 'No device can do it yet. Add one under Devices: a robot alone brings nothing about, what it carries does.',
		action: 'What it does',
		actions: { close: 'closes', open: 'opens' },
		robot: 'Robot',
		pose: 'Stands in the pose',
		addStand: 'A robot stands in a pose meanwhile',
		removeStand: 'Take away: where the robot stands',
		then: 'When it is done',
		thens: { next: 'The next one comes by itself', order: 'The next one comes with an order, where the station works by order', once: 'Nothing follows' }
	},
	never: {
		nothing: 'Say first which devices there are and what is made.',
		none: 'Nothing yet. Say what would be dangerous, or would break something.',
		rule: (n: number): string => `Rule ${n}`,
		group: (rule: number, label: string): string => `Rule ${rule}: ${label}`,
		never: 'Never',
		while: 'while',
		and: 'and',
		thing: 'Of what',
		way: 'Is or is not',
		is: 'is',
		isNot: 'is not',
		value: 'What it can be',
		removeFact: 'Take away: this part',
		addAnd: 'and',
		addWhile: 'while',
		add: 'Add a rule',
		suggested: 'Suggestions',
		take: 'Add',
		takeIt: (text: string): string => `Add: ${text}`,
		called: (title: string): string => `It is called “${title}”.`,
		uncall: 'Call it as it reads'
	},
	values: { running: 'running', idle: 'idle', open: 'open', closed: 'closed', busy: 'busy', free: 'free', under_way: 'under way' },
	documents: {
		title: 'Documents',
		label: 'Document',
		notYet: 'The documents are here as soon as nothing is missing.',
		missing: 'Still to put right',
		old: 'As it was before. Something is still to put right.'
	},
	/** What was said, in words. */
	sentence: {
		station: (title: string): string => `The station is called “${title}”.`,
		robot: (title: string, poses: string, row: boolean): string =>
			poses === '' ? `${title} has no pose yet.` : row ? `${title} goes along a row: ${poses}.` : `${title} goes between ${poses}, any way.`,
		arm: (title: string): string => `${title} goes to named poses.`,
		tool: (title: string): string => `${title} runs until it is done.`,
		clamp: (title: string): string => `${title} opens and closes.`,
		person: (title: string): string => `${title} is asked for tasks on a watch.`,
		found: (title: string, n: number): string => `${title} is on the network, with ${count(n, 'topic', 'topics')}.`,
		first: (product: string, state: string): string => `At first ${product} is ${state}.`,
		step: (step: string, by: string, from: string, to: string, how: string): string => `${step}: ${by} brings it from ${from} to ${to}${how}.`,
		how: { close: ' by closing', open: ' by opening' },
		stands: (robot: string, pose: string): string => `${robot} is in the pose “${pose}”`,
		meanwhile: (done: string, where: string): string => `${done} Meanwhile ${where}.`,
		then: {
			next: (product: string): string => `When ${product} is done the next one comes by itself.`,
			order: (product: string): string => `When ${product} is done the next one comes with an order. For that press By order on Orders.`,
			once: (product: string): string => `When ${product} is done nothing follows.`
		},
		fact: (thing: string, value: string, holds: boolean): string => `${thing} ${holds ? '' : 'not '}${value}`,
		during: (thing: string, value: string, holds: boolean): string => `${thing} is ${holds ? '' : 'not '}${value}`,
		inPose: (pose: string): string => `in the pose “${pose}”`,
		never: (facts: string, during: string | null): string => `Never ${facts}${during === null ? '' : ` while ${during}`}`
	},
	put: {
		said: 'What you said',
		nothing: 'Nothing was said yet. Begin with Station.',
		errors: 'The documents cannot be used as they are',
		do: 'Put it into the draft',
		next: 'It opens in Model: see what the check finds, try it in simulation, then review the changes. What runs goes on as it is until you deploy.',
		wrong: (n: number): string => `Not yet: ${count(n, 'thing is', 'things are')} still to put right.`,
		asking: 'The documents are being made.',
		unknown: 'The server cannot be reached. What you wrote is kept here.',
		replaceTitle: 'Replace what is in the draft?',
		replaceMeans: 'The draft holds more than its name. It is one change, which Undo takes back.',
		replaced: 'Written otherwise:',
		removed: 'Taken away:',
		replace: 'Replace the draft',
		change: (title: string): string => (title === '' ? 'Station made step by step' : `Station “${title}” made step by step`),
		attaching: (topic: number, of: number): string => `Topic ${topic} of ${of} is being taken in.`,
		notMade: 'The model cannot take it in.'
	},
	begun: {
		title: 'What comes next',
		next: 'The station is in the draft. Next:',
		check: 'See what the check finds',
		failed: 'These topics could not be taken in:'
	},
	/** Where the draft holds nothing. */
	empty: {
		title: 'This station is empty',
		about: 'Answer some questions and get a station that can be checked and tried, or write each part yourself.',
		steps: 'Build it step by step',
		part: 'Begin with an empty part…'
	},
	/** In the tools of Model. */
	tool: 'Step by step'
};
