import { count } from '../count.ts';

/** Orders: what is asked of the station, where that stands, and what was made. */
export const orders = {
	summary: (made: string, left: number, held: number, last: string | null): string => {
		const open = [left > 0 || held === 0 ? `${left === 0 ? 'none' : left} to be made` : '', held > 0 ? `${held} not released` : ''];
		return `${made} made by order today, ${open.filter(Boolean).join(', ')}${last === null ? '' : `; the last is expected at ${last}`}`;
	},
	work: 'How the station works',
	ways: {
		order: {
			name: 'By order',
			means: 'The station makes only what is ordered.',
			title: 'Let the station work by order?',
			word: 'Work by order',
			follows: 'From now on the station makes only what is ordered. What is in work without an order is left unfinished.'
		},
		freely: {
			name: 'Freely',
			means: 'The station goes on with the next product by itself, and orders wait.',
			title: 'Let the station work freely?',
			word: 'Work freely',
			follows: 'From now on the station goes on with the next product by itself, and orders wait.'
		}
	},
	columns: { stored: 'Not released', waiting: 'Waiting', worked: 'In work', over: 'Over today' },
	madeOf: (n: string): string => `${n} made`,
	noneYet: {
		title: 'No orders yet',
		unknown: 'Whether there are orders is not known',
		impossible: 'Nothing can be ordered',
		freely: 'The station works freely: it goes on with the next product by itself. With an order you say what is made and when it is due; a MES can send orders too.',
		byOrder: 'The station works by order: it makes nothing until there is one. Orders come from a MES, or are made here.'
	},
	empty: {
		stored: 'Orders stand here until somebody allows them to start.',
		waiting: 'Orders that may start stand here, in the order in which they are to begin.',
		worked: 'No order in work.',
		over: 'No order is over today.'
	},
	before: (n: number): string => count(n, 'order before today', 'orders before today'),
	moreThanShown: 'There are more orders than are shown here.',
	next: 'next',
	more: (title: string): string => `More for ${title}`,
	priority: 'Priority',
	priorityOf: (n: number): string => `priority ${n}`,
	due: 'Due',
	dueAt: (time: string): string => `due ${time}`,
	startsAt: (time: string): string => `starts ${time}`,
	readyAt: (time: string): string => `ready ${time}`,
	soFar: (time: string): string => `${time} so far`,
	id: 'Number',
	began: 'Begun',
	stored: 'Stored',
	expectedStart: 'Expected to begin',
	expectedEnd: 'Expected to be ready',
	operations: 'Operations',
	steps: { waiting: 'waits', eligible: 'can begin', active: 'running', completed: 'done', skipped: 'not needed' },
	pauseMeans: 'A paused order starts no operation; what runs may finish. To stop the station use Pause or Hold above.',
	states: {
		NotAllowedToStart: 'not released',
		AllowedToStart: 'waiting',
		Running: 'running',
		Interrupted: 'paused',
		Ended: 'ended',
		Aborted: 'aborted'
	},
	/** Of an order that is in work while the station does not go on. */
	standstill: { stopped: 'stopped', waits: 'waits' },
	/** Why it is paused, as whoever paused it said. */
	pausedBecause: (why: string): string => `Paused: ${why}`,
	commands: {
		Start: 'Allow to start',
		RevokeStart: 'Do not start yet',
		Pause: 'Pause order',
		Resume: 'Resume order',
		Stop: 'Stop after operation',
		Abort: 'Abort order',
		Cancel: 'Withdraw order',
		Clear: 'Clear order'
	},
	commandOf: (command: string, title: string): string => `${command}: ${title}`,
	commandTitle: (command: string, title: string): string => `${command}: ${title}`,
	means: {
		Start: 'It begins as soon as its turn comes.',
		RevokeStart: 'It does not begin until somebody allows it to start again.',
		Pause: 'None of its operations begins; what runs may finish.',
		Resume: 'Its operations go on. Devices may move at once.',
		Stop: 'What is active is completed, and nothing more begins.',
		Abort: 'What is active is put aside at once; what runs may finish.',
		Cancel: 'The order is taken away, and nothing of it is made.',
		Clear: 'The order is not listed any more. The journal keeps it.'
	},
	commanded: (command: string): string => `Asked for: ${command}. It is not done yet.`,
	progress: (done: number, all: number): string => `${done} of ${all}`,
	waits: (reasons: string): string => `Waits: ${reasons}`,
	late: (time: string): string => `${time} late`,
	lateAtMost: (time: string): string => `under ${time} late`,
	notBefore: (time: string): string => `not before ${time}`,
	by: (name: string): string => `from ${name}`,
	found: 'Best for the due times and the durations known by now.',
	freely: 'No times yet: the station works freely, and orders wait.',
	foundSoon: 'The best that was found in time for the due times and the durations known by now.',
	foundNot: (why: string): string => `By priority and due time: ${why}.`,
	line: {
		title: 'Order of work',
		window: 'Part of the time line',
		station: 'Station',
		minutes: (n: number): string => `${n} min`,
		hours: (n: number): string => `${n} h`,
		dueLane: 'Due',
		dueOf: (title: string, time: string): string => `${title}, due ${time}`,
		unknown: 'nobody knows when',
		late: 'late',
		withoutTime: (n: number): string =>
			n === 1 ? '1 order has no expected time yet.' : `${n} orders have no expected time yet.`,
		bars: {
			past: (title: string, from: string, to: string): string => `${title}, made from ${from} to ${to}`,
			run: (title: string, from: string, to: string): string => `${title}, in work since ${from}, ready: ${to}`,
			next: (title: string, from: string, to: string): string => `${title}, next: from ${from} to ${to}`,
			plan: (title: string, from: string, to: string): string => `${title}, expected from ${from} to ${to}`
		}
	},
	newTitle: 'New order',
	workMaster: 'What is made',
	noWorkMaster: 'The model of this station has no work master, so nothing can be ordered. An engineer adds one on the page Model.',
	description: 'Description',
	first: 'The highest is made first. 0 is normal.',
	earliest: 'Not before',
	startAtOnce: 'Release it now: it is made when it is its turn',
	store: 'Add order',
	isStored: (title: string): string => `The order ${title} is on the board.`,
	done: (command: string, title: string): string => `${command}: ${title}. Done.`,
	outcomes: { completed: 'completed', stopped: 'stopped', aborted: 'aborted', cancelled: 'withdrawn' },
	reason: 'Reason',
	operationsMade: (done: number, all: number): string => `${done} of ${all} operations completed`,
	startsMade: (n: number): string => count(n, 'start of an ability', 'starts of abilities'),
	corrections: (n: number): string => count(n, 'correction', 'corrections'),
	deviations: (n: number): string => count(n, 'deviation', 'deviations'),
	wentOtherwise: 'What went otherwise',
	details: (title: string): string => `What was made for ${title}`,
	operation: 'Operation',
	from: 'From',
	took: 'Took',
	because: (by: string, why: string): string => `${by}: ${why}`
};
