import { count } from '../count.ts';

/** Alarms. */
export const alarms = {
	title: 'Alarms',
	priority: { high: 'High', medium: 'Medium', low: 'Low' },
	priorityOf: { high: 'High priority', medium: 'Medium priority', low: 'Low priority' },
	state: {
		unacknowledged: 'not acknowledged',
		returned: 'not acknowledged',
		acknowledged: 'acknowledged',
		notice: 'notice',
		shelved: 'shelved',
		'out-of-service': 'out of service'
	},
	lasts: (duration: string): string => `for ${duration}`,
	lasted: (duration: string): string => `lasted ${duration}`,
	overSince: (when: string): string => `Over since ${when}`,
	since: (when: string): string => `since ${when}`,
	came: (times: number): string => `came ${times} times`,
	by: (name: string): string => `by ${name}`,
	until: (when: string): string => `until ${when}`,
	causeOver: 'its cause is over',
	parts: (n: number): string => `+${n} from this cause`,
	none: 'No alarms',
	noneWhenHeard: 'No alarms when last heard',
	noneOfThese: 'None of these',
	othersHidden: 'The filter hides the others.',
	aside: (n: number): string => `${n} shelved or out of service`,
	means: 'What it means',
	todo: 'What to do',
	more: (n: number): string => `+${n} more`,
	inHistory: 'See it in History',
	said: {
		alarm: (priority: string, text: string): string => `${priority} alarm: ${text}`,
		live: 'Live',
		old: 'Not live: what is shown is old',
		mode: (mode: string): string => `Mode: ${mode}`,
		task: (title: string): string => `For you: ${title}`
	},
	which: 'Which alarms',
	emptyAbout: 'As soon as something is wrong, it stands here, with what to do about it.',
	sections: { fresh: 'Not acknowledged', seen: 'Acknowledged', notices: 'Notices', over: 'Over, today' },
	detail: {
		label: 'The alarm that is chosen',
		happened: 'What happened',
		means: 'What it means',
		todo: 'What to do',
		came: 'How it came about',
		over: 'Its cause is over',
		history: 'All of it in History'
	},
	/** That nothing comes, by what it would tell; empty where nothing is called. */
	silences: {
		'silent.no-message-yet': (of) => (of ? `No message yet: ${of}` : 'No message yet'),
		'silent.no-message': (of) => (of ? `No more messages: ${of}` : 'No more messages'),
		'silent.no-message-past': (of) => (of ? `For some time no message came: ${of}` : 'For some time no message came'),
		'silent.no-answer-yet': (of) => (of ? `No answer yet: ${of}` : 'No answer yet'),
		'silent.no-answer': (of) => (of ? `No answer any more: ${of}` : 'No answer any more'),
		'silent.no-answer-past': (of) => (of ? `For some time no answer came: ${of}` : 'For some time no answer came')
	} as Readonly<Record<string, (of: string) => string>>,
	standing: 'Standing',
	setAside: 'Shelved and out of service',
	asideAbout: 'People are not told of these, because somebody wanted that.',
	acknowledge: 'Acknowledge',
	all: {
		button: (n: number): string => `Acknowledge all ${n} shown`,
		title: (n: number): string => (n === 1 ? 'Acknowledge 1 alarm?' : `Acknowledge ${n} alarms?`),
		means: 'You say that you know of these. Their causes stay as they are. One that comes again meanwhile is not acknowledged.',
		word: 'Acknowledge these',
		refused: (n: number): string =>
			n === 1 ? '1 of them was not acknowledged:' : `${n} of them were not acknowledged:`,
		moved: 'It came again after this list was made: it stays.',
		gone: 'It is gone or acknowledged by now.'
	},
	shelve: {
		ask: 'Shelve…',
		button: 'Shelve',
		title: 'Shelve this alarm?',
		means: 'Silent for that long. If it becomes high, you are told.',
		how: 'For how long',
		span: (minutes: number): string =>
			minutes < 60 ? `${minutes} minutes` : minutes === 60 ? '1 hour' : `${minutes / 60} hours`,
		until: (when: string): string => `until about ${when}`,
		done: (when: string): string => `The alarm is shelved until about ${when}`,
		back: 'Tell it again'
	},
	suppress: {
		ask: 'Take out of service…',
		button: 'Take out of service',
		title: 'Take this alarm out of service?',
		means: 'Nobody is told of it until an engineer puts it back. Its cause stays as it is.',
		done: 'The alarm is out of service',
		back: 'Put back in service'
	},
	changed: 'It has changed since this was opened:',
	goneNow: 'The alarm is gone.',
	links: {
		resource: (title: string): string => `State of ${title}`,
		topics: (n: number): string => (n === 1 ? 'Its topic' : `Its ${n} topics`),
		restart: 'Choose a way back',
		label: 'Where to look'
	},
	filter: {
		button: 'Filter',
		label: 'Which alarms are shown',
		state: 'State',
		priority: 'Priority',
		resource: 'Resource',
		any: 'all',
		option: (word: string, n: number): string => `${word} (${n})`,
		clear: 'Show all',
		shown: (shown: number, all: number): string => `${shown} of ${all} are shown.`
	},
	figures: {
		aside: 'Set aside',
		tenMinutes: 'Last 10 min',
		hour: 'Last hour',
		course: (each: string): string => `Alarms in each ten minutes of the last hour: ${each}`,
		floodBegins: 'Flood: 10 or more in 10 min.',
		atLeast: (n: number): string => `at least ${n}`,
		flood: 'Too many for one person.',
		frequent: 'Most frequent',
		times: (n: number): string => (n === 1 ? 'once' : `${n} times`),
		notKnown: 'not known'
	},
	/** How many came in each hour. */
	perHour: {
		title: 'Alarms per hour',
		span: 'How far back',
		spans: { 8: '8 h', 24: '24 h' },
		when: 'Hour',
		alarms: 'Alarms',
		hour: (from: string, to: string): string => `${from} to ${to}`,
		n: (n: number): string => count(n, 'alarm', 'alarms'),
		label: (n: number, hours: number, worst: number): string =>
			`${count(n, 'alarm', 'alarms')} in the last ${hours} hours, at most ${worst} in an hour`,
		level: (n: number): string => `Dotted: ${n} an hour. One person can follow that many for long (ISA-18.2).`,
		tooMany: 'There were too many alarms to show all of them here. History has the rest.'
	},
	earlier: {
		title: 'Earlier',
		about: 'Alarms that are over, and of which people took note, the newest first.',
		caption: 'Alarms that are over, the newest first',
		alarm: 'Alarm',
		came: 'Came',
		ended: 'Ended',
		lasted: 'Lasted',
		seen: 'Acknowledged by',
		none: 'None so far',
		howYet: 'An alarm that is over and was acknowledged comes here.',
		older: 'Older',
		reading: 'Reading',
		noOlder: 'There is nothing older.',
		operators: 'Operators may read what was earlier, and how often alarms came.'
	},
	tone: {
		on: 'Sound on',
		off: 'Sound off',
		label: 'A short tone for each new alarm of high priority',
		about: 'In this browser alone, as long as a page of the station is open and live. Do not rely on it: a device may be muted, and a browser asleep.',
		hear: 'Hear it',
		waiting: 'No sound yet: the browser allows it once something has been pressed on this page.',
		missing: 'This browser cannot sound.'
	}
};
