import type { Standby } from '#lib/contract.ts';

/** The frame of the pages: what is said of the station as a whole, on every page. */
export const frame = {
	pages: 'Pages',
	/** Groups of pages. */
	groups: { operate: 'Operate', engineer: 'Engineer', plant: 'Plant admin' },
	skip: 'Skip to the page',
	collapse: 'Collapse',
	expand: 'Expand',
	morePages: 'More',
	emulated: 'Emulated',
	emulatedMeans: 'The devices are emulated.',
	mode: {
		automatic: 'Automatic',
		paused: 'Paused',
		hold: 'Hold',
		restart: 'Restart'
	},
	/** What a mode means for what happens next, once production is started. */
	meaning: {
		automatic: 'Operations are carried out.',
		paused: 'Running steps finish. Nothing new starts.',
		hold: 'Nothing starts. What could be stopped has stopped.',
		restart: 'Operations wait. Only what you approve starts.'
	},
	nothingSent: 'Devices get no commands before production starts.',
	production: {
		preparing: 'Getting ready. Nothing is started.',
		waiting: 'Ready. Production is not started.',
		started: 'Production is started.'
	},
	preparing: 'The controller only listens, and asks the network whether somebody else commands these devices. No command is taken until that is known.',
	/** Of several stations for the same devices: what this one does, and what keeps it from that. */
	standby: ({ active, holder, trouble }: Standby): string => {
		if (trouble !== null) return `This is one of several stations, and cannot take the command: ${trouble}.`;
		if (!active) return `This station stands by: ${holder ?? 'nobody'} commands the devices.`;
		return 'No other station stands by: nobody would take over from this one.';
	},
	beingComputed: (what: string): string => `Being computed: ${what}.`,
	/** The states of PackML by the names that the standard has for them. */
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
	stepByStep: 'Step by step',
	pausesAfter: 'then pauses',
	pausedAfter: 'product done',
	atBreakpoint: 'breakpoint',
	pausesBy: (who: string, why: string): string => `The station pauses when this product is done, as ${who} asked${why === '' ? '.' : `: ${why}`}`,
	pause: 'Pause',
	hold: 'Hold',
	holdMeans: 'Pause, and call off what runs',
	notRecorded: 'Stopped. The journal does not have it yet; the station keeps it until then.',
	goOn: 'Continue',
	start: 'Start production',
	takeControlFirst: 'Take control first',
	lookOn: (role: string): string => `You look on as ${role}; an operator acts.`,
	alarms: (n: number): string => (n === 1 ? '1 alarm' : `${n} alarms`),
	/** A revision that somebody else has saved, to who may approve it. */
	waits: {
		said: (number: number, name: string, by: string): string => `Revision ${number}, “${name}”, by ${by} waits for a second person’s approval.`,
		look: 'Look at the changes'
	},
	undeployed: (n: number): string => (n === 1 ? '1 change is not deployed' : `${n} changes are not deployed`),
	noAlarms: 'No alarms',
	/** `over`: those that are over and that nobody has acknowledged, where no others stand. */
	alarmsWhenHeard: (n: number, over: number): string =>
		n > 0 ? `${n === 1 ? '1 alarm' : `${n} alarms`} when last heard` : over > 0 ? `${over} over, not acknowledged, when last heard` : 'No alarms when last heard',
	moreAlarms: (n: number): string => `+${n}`,
	alarmsOver: (n: number): string => `${n} over, not acknowledged`,
	notAcknowledged: (n: number): string => `${n} not acknowledged`,
	notLive: 'Not live',
	notLiveFor: (age: string): string => `Not live · ${age} old`,
	connecting: 'Connecting',
	notLiveStrong: 'Not live.',
	lastHeard: (age: string): string => `This view is ${age} old. The station may have moved on.`,
	tryNow: 'Try now',
	/** They are sent from an old view too; whether they arrive nobody knows. */
	relyNot: 'Nothing that is sent from here, Pause and Hold neither, is sure to arrive.',
	safetyDevices: 'To stop, use the safety devices of the station.',
	notUnderstood: (what: string): string => `The server did not understand this page: ${what}`,
	/** Why a view is old. */
	causes: {
		connecting: 'Connecting to the station.',
		closed: 'The connection to the server is lost. Trying again.',
		controller: 'The server does not hear the controller.',
		gap: 'A message was lost. Loading again.',
		silent: 'Nothing new has come from the server.'
	},
	mayStart: 'may start now',
	/** What is said in the place of the next start where there is none. */
	nothingNext: {
		idle: 'nothing to plan',
		order: 'the order is paused; it is resumed under Orders',
		noOrder: 'waits for an order that may start',
		planning: 'a plan is being looked for',
		followed: 'nothing more to start',
		waits: 'waits for the running steps',
		broken: 'the plan no longer fits; planning again',
		none: 'no plan was found',
		paused: 'nothing starts in this mode',
		production: 'nothing starts before production does'
	},
	release: 'Release',
	/** Shown to whoever is new here, beside what each step is about. */
	round: {
		offer: 'New here? Five short steps show you around.',
		show: 'Show me around',
		notNow: 'Not now',
		skip: 'Skip',
		back: 'Back',
		next: 'Next',
		end: 'Start working',
		stepOf: (n: number, all: number): string => `Step ${n} of ${all}`,
		steps: [
			{ title: 'The station', text: 'This picture is the station as it is now: what each device does, and how far the product is. Press anything in it for its values and why it waits.' },
			{ title: 'The plan', text: 'What runs, what comes next, and what waits for what. When the station changes, there is a new plan.' },
			{ title: 'Your task', text: 'What the station asks of you stands here. Do it, then press Done. If it cannot be done, press Problem: somebody comes, and nothing stops.' },
			{ title: 'Pause and Hold', text: 'Pause: running steps finish, nothing new starts. Hold: what can be stopped stops at once. Both are on every page and ask nothing. Neither is an emergency stop.' },
			{ title: 'When it stops', text: 'An alarm says what failed and what to do. The page Restart then leads back to production, one step at a time.' }
		] as readonly { readonly title: string; readonly text: string }[]
	},
	notices: 'Notices',
	help: (page: string): string => `Help: ${page}`,
	search: 'Search or act',
	/** Said of Pause or Hold where the view does not show what became of it. */
	stopSaid: {
		arrived: { paused: 'Pause has arrived at the station. This view is still old.', hold: 'Hold has arrived at the station. This view is still old.' },
		notSent: { paused: 'Pause was not sent.', hold: 'Hold was not sent.' },
		noAnswer: { paused: 'Pause was not answered: nobody knows whether it has arrived.', hold: 'Hold was not answered: nobody knows whether it has arrived.' }
	},
	palette: {
		title: 'Search or act',
		missing: 'It could not be loaded. Load this page again.',
		hint: 'A page, variable, ability, operation or act',
		nothing: (typed: string): string => `Nothing is called “${typed}”.`,
		examples: 'Example stations',
		/** What is asked of an operation, by how it stands. */
		why: {
			waits: (operation: string): string => `Why does “${operation}” wait?`,
			active: (operation: string): string => `When is “${operation}” done?`,
			stopped: (operation: string): string => `Why does “${operation}” stand still?`,
			done: (operation: string): string => `“${operation}” is done. When does it begin again?`
		},
		groups: { act: 'Possible now', page: 'Pages', alarm: 'Alarms', operation: 'Operations', ability: 'Abilities', variable: 'Variables' }
	},
	noStation: 'Nothing is known of the station yet.',
	/** Of what is not live. */
	asOf: (clock: string): string => `as it was at ${clock}`,
	/** Of a chart. */
	asTable: 'as table',
	takeBack: 'Take back',
	/** Why, in the journal. */
	takenBack: 'Taken back at once',
	reasonMissing: 'Say why: it is written into the journal.',
	/** Of a field. */
	needed: '(needed)'
};
