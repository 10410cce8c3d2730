import type { Standby } from '#lib/contract.ts';

/** The header: what is said of the station as a whole, on every page. */
export const header = {
	pages: 'Pages',
	menu: 'Menu',
	/** Groups of pages. */
	groups: { operation: 'Operation', engineering: 'Engineering' },
	emulated: 'emulated devices',
	mode: {
		automatic: 'Automatic',
		paused: 'Paused',
		hold: 'Hold',
		restart: 'Restart'
	},
	/** What a mode means for what happens next, once production is started. */
	meaning: {
		automatic: 'Operations are carried out.',
		paused: 'What runs may finish; nothing is started.',
		hold: 'Nothing is started, and what ran was called off where that is possible.',
		restart: 'Operations wait. Nothing is started but what a person has looked at and taken.'
	},
	nothingSent: 'Nothing is sent to the devices until production is started.',
	production: {
		preparing: 'preparing: nothing moves yet',
		waiting: 'waits for the start of production',
		started: 'production started'
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
	stepByStep: 'step by step',
	control: (who: string): string => `control: ${who}`,
	pause: 'Pause',
	hold: 'Hold',
	holdMeans: 'Pause, and call off what runs',
	notRecorded: 'Stopped. The journal does not have it yet; the station keeps it until then.',
	goOn: 'Continue',
	start: 'Start production',
	takeControlFirst: 'Take control first',
	lookOn: (role: string): string => `You look on as ${role}; an operator acts.`,
	alarms: (n: number): string => (n === 1 ? '1 alarm' : `${n} alarms`),
	noAlarms: 'no alarms',
	alarmsOver: (n: number): string => `${n} over, not acknowledged`,
	notAcknowledged: (n: number): string => `${n} not acknowledged`,
	liveAgo: (age: string): string => `live ${age} ago`,
	notLive: 'not live',
	notLiveFor: (age: string): string => `not live, ${age} old`,
	connecting: 'connecting',
	notLiveStrong: 'Not live.',
	lastHeard: (age: string): string => `What is shown is old: last heard ${age} ago.`,
	notUnderstood: (what: string): string => `The server did not understand this page: ${what}`,
	/** Why a view is old. */
	causes: {
		connecting: 'Connecting to the station.',
		closed: 'The connection to the server is lost. Trying again.',
		controller: 'The server does not hear the controller.',
		gap: 'A message was lost on the way. A new picture has been asked for.',
		silent: 'Nothing new has come from the server.'
	},
	carriedOut: 'Carried out',
	by: (name: string): string => `by ${name}`,
	active: 'Active',
	noOperation: 'no operation',
	next: 'Next',
	more: (n: number): string => `and ${n} more`,
	waitsFor: 'waits for',
	mayStart: 'may start now',
	/** What is said in the place of the next start where there is none. */
	nothingNext: {
		idle: 'nothing to plan',
		planning: 'a plan is being looked for',
		followed: 'nothing more to start',
		waits: 'nothing to start: what runs is waited for',
		broken: 'the station departed from the plan; a new one is being looked for',
		none: 'no plan was found',
		paused: 'nothing is started in this mode',
		production: 'nothing is started before production is'
	},
	release: 'Release'
};
