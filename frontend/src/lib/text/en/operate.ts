/** Operate. */
const starts = (n: number): string => (n === 1 ? '1 start' : `${n} starts`);

export const operate = {
	/** Another model comes once the product in work is done. */
	change: {
		product: (name: string): string => `The model is changed to “${name}” when this product is done.`,
		orders: (name: string): string => `The model is changed to “${name}” when the orders in work are done.`,
		by: (who: string, at: string, why: string): string => `${who}, ${at}: ${why}`
	},
	title: 'Operate',
	plan: {
		/** After a run that came to no end. */
		wayBack: 'depends on the way back',
		title: 'Plan',
		asTable: 'as table',
		aboutPlan: 'About the plan',
		operation: 'Operation',
		whole: 'All',
		waiting: 'Waits',
		waitsFor: (people: string): string => `Waits for ${people}`,
		plannedFor: (seconds: number): string => (seconds < 100 ? `planned for ${seconds} s` : `planned for ${Math.round(seconds / 60)} min`),
		since: { broken: (at: string): string => `Broken at ${at}`, none: (at: string): string => `No plan since ${at}`, stopped: (at: string): string => `Stopped at ${at}` },
		stopped: 'stopped',
		after: (title: string): string => `after ${title}`,
		lanes: 'Plan as lanes',
		later: (n: number): string => `${n === 1 ? '1 step' : `${n} steps`} later than what is drawn: see the table.`,
		steps: 'Steps of the plan',
		timeShown: 'Time shown',
		seconds: (n: number): string => (n < 60 ? `${n} s` : `${n / 60} min`),
		statusText: {
			planning: 'Planning',
			followed: 'Followed'
		},
		replanned: (n: number): string => `Planned again ${n === 1 ? 'once' : `${n} times`}.`,
		next: 'Next',
		step: { done: 'done', running: 'running', next: 'next', planned: 'planned' },
		isNew: 'new',
		unheard: 'running when last heard',
		changed: (ago: string): string => `The plan changed ${ago}`,
		unchanged: 'The plan has not taken the place of another.',
		dropped: 'Dropped',
		added: 'New',
		onlyOrder: 'The same starts in another order.',
		columns: {
			expected: 'Began or expected',
			resource: 'Resource',
			step: 'Step',
			status: 'Status',
			lasts: 'Lasted or expected to',
			waits: 'Waits for'
		},
		inSeconds: (n: number): string => (n === 0 ? 'now' : `in ${n} s`),
		about: (n: number): string => `about ${n} s`,
		droppedStatus: 'dropped',
		shortest: (ahead: number): string => `The shortest plan there is, proven: ${starts(ahead)} to come.`,
		soon: (fewest: boolean, ahead: number): string => `Found soon: ${starts(ahead)} to come. ${fewest ? 'No plan is shorter.' : 'There may be a shorter plan.'}`,
		ends: (seconds: number): string => `Done in about ${seconds} s.`,
		answered: (time: string): string => `Found in ${time}.`,
		answeredBy: (time: string, engine: string): string => `Found in ${time} by ${engine}.`,
		whyNone: 'Why there is no plan',
		noneWhile: (several: boolean): string =>
			`No plan as long as ${several ? 'all of these stay as they are' : 'this stays as it is'}:`,
		perhapsNeedless: 'Some of it may be needless: there was no time to find out.',
		thereWouldBe: (several: boolean): string =>
			`There would be a plan again with ${several ? 'one of these' : 'this'}:`
	},
	why: {
		ask: 'Why?',
		askOf: (title: string): string => `Why? ${title}`,
		of: (title: string): string => `What “${title}” waits for`,
		/** Of an operation that is done. */
		doneOf: (title: string): string => `“${title}” is done`,
		beginsAgain: 'It begins again when',
		nothing: 'Nothing is in its way.',
		goalHolds: 'It is done.',
		again: 'Ask again',
		asked: (clock: string): string => `As it was at ${clock}`,
		asking: 'Asking',
		kind: {
			station: 'The station',
			service: 'Service',
			written: 'Condition of the model',
			unpublished: 'Command on its way',
			supervisor: 'Kept back by the supervisor',
			plan: 'Plan',
			order: 'Order'
		} as Readonly<Record<string, string>>,
		since: (value: string, time: string): string => `${value}, since ${time}`,
		heardOn: (topic: string): string => `heard on ${topic}`,
		notConfirmed: 'not confirmed',
		changers: 'Could be changed by',
		nobody: 'nobody',
		how: {
			start: (title: string, running: boolean): string => `the start of “${title}”${running ? ', which runs' : ''}`,
			finish: (title: string, running: boolean): string => `the end of “${title}”${running ? ', which runs' : ''}`,
			effect: (title: string, running: boolean): string => `what “${title}” does${running ? ', which runs' : ''}`,
			correction: (): string => 'a correction by a person',
			force: (): string => 'forcing the output'
		} as Readonly<Record<string, (title: string, running: boolean) => string>>,
		plan: (n: number): string => `A plan is at hand: ${starts(n)}.`,
		about: {
			enabled: 'It can start when',
			start: 'It starts when',
			supervisor: 'The supervisor allows it when',
			finish: 'It is done when',
			precondition: 'It begins when',
			turn: 'It is its turn when',
			goal: 'It is done when',
			undone: 'Why it is done',
			predicate: 'It is so when'
		},
		sake: (titles: string): string => `for the sake of ${titles}`,
		toRest: 'so that the station can come to rest again',
		inSequence: (name: string): string => `in the sequence ${name}`,
		truth: { holds: 'holds', fails: 'does not hold', open: 'not known' },
		joined: {
			all: 'All of these:',
			any: 'One of these:',
			not: 'Not this:',
			implies: 'The second, if the first:',
			same: 'Which means:'
		},
		called: (predicate: string): string => `is called ${predicate}`,
		mustEnd: 'must not be so',
		others: (n: number): string => (n === 1 ? '1 more, which does not decide' : `${n} more, which do not decide`),
		above: 'stands above',
		operation: (title: string): string => `the operation ${title}`
	},
	operations: {
		title: 'Operations',
		/** Of a word, where several are counted. */
		plural: (word: string): string => (word.endsWith('s') ? word : `${word}s`),
		/** Of one that does not begin as its goal holds already. */
		startFirst: 'Begins once production is started',
		modeFirst: 'Waits for automatic mode',
		soAlready: 'Not needed now',
		noOrder: 'No order asks for it',
		orderPaused: 'Its order is paused',
		laterInOrder: 'Comes later in its order',
		doneOf: (done: number, all: number): string => `${done} of ${all} done`,
		of: (done: number, all: number): string => `${done} of ${all}`,
		stopped: 'stopped',
		standing: { done: 'done', active: 'active', stopped: 'stopped', waits: 'waits' },
		completed: (n: number): string => `${n}× completed`,
		none: 'No operations',
		noneHow: 'What the station makes is written in the model.',
		once: 'done once: active again after a reset',
		out: 'out of service',
		asked: {
			later: (job: string): string => `later in ${job}`,
			now: (job: string): string => `for ${job}`,
			done: (job: string): string => `done for ${job}`,
			skipped: (job: string): string => `not needed for ${job}`
		} as Readonly<Record<'later' | 'now' | 'done' | 'skipped', (job: string) => string>>,
		leftOut: 'not in the plan'
	},
	service: {
		title: 'Out of service',
		of: { resource: 'resource', ability: 'ability', operation: 'operation' } as Readonly<Record<string, string>>,
		since: (clock: string, by: string, why: string): string => `since ${clock}, ${by}: ${why}`,
		byStation: 'given up by the station',
		putBack: 'Put back',
		putBackTitle: (title: string): string => `Put ${title} back into service?`,
		becauseOf: (why: string): string => `It was taken out because: ${why}`,
		takeOut: 'Take out of service',
		isOut: (title: string): string => `${title} is out of service`,
		isBack: (title: string): string => `${title} is back in service`,
		takeOutOf: (title: string): string => `Take out of service: ${title}`,
		takeOutTitle: (title: string): string => `Take ${title} out of service?`,
		means: {
			resource: 'Its abilities do not start, and nothing that its devices would do is counted on. What of it runs goes on. Plans are made without it until somebody puts it back.',
			ability: 'It does not start; what runs of it goes on. Plans are made without it until somebody puts it back.',
			operation: 'It does not become active, and is not active any more, until somebody puts it back.'
		} as Readonly<Record<string, string>>
	},
	whoCan: {
		title: 'Who can do what',
		nobody: (n: number): string => (n === 1 ? 'Nobody can do this now' : 'Nobody can do these now'),
		lacks: (what: string): string => `needs ${what}`,
		others: 'This can still be done',
		by: (whom: string): string => `by ${whom}`,
		goesOn: 'by what is already under way',
		once: (what: string): string => `as soon as ${what}`,
		later: (n: number): string => (n === 1 ? '1 that comes later' : `${n} that come later`),
		/** How many of each there are, where it is not told in full. */
		counts: (nobody: number, others: number): string =>
			[nobody > 0 ? `${nobody} cannot be done now` : '', others > 0 ? `${others} can still be done` : ''].filter(Boolean).join(' · '),
		absent: {
			silent: (n: number): string => (n === 1 ? 'is not heard' : 'are not heard'),
			'out of service': (n: number): string => (n === 1 ? 'is out of service' : 'are out of service')
		} as Readonly<Record<string, (n: number) => string>>
	},
	supervisor: {
		noShort: 'no short rule; show the states',
		blocked: 'Not, among others, where:',
		expanded: 'Written out',
		none: 'There is no supervisor, so nothing is started.',
		about: (number: string): string => `about ${number}`,
		reached: (number: string, one: boolean): string => `${number} ${one ? 'state' : 'states'} can be reached`,
		supervised: (number: string): string => `${number} of them with the supervisor`,
		atMost: (number: string): string => `At most ${number} states can be reached with the supervisor`
	},
	/** Whoever is asked for something says what is in the way; on the watch with one touch, and nothing more. */
	task: {
		yours: 'Your task',
		notStarted: 'Production is not started',
		startAbove: 'Start it in the bar above when the station is ready. Nothing is sent to devices before.',
		startHere: 'Nothing is sent to devices before a person starts it.',
		startedBy: (name: string): string => `${name} has control, and can start it.`,
		comesHere: 'What the station asks of you comes here.',
		goesOn: 'Your task goes on',
		toldAbove: 'Its problem is told above',
		thenBegins: 'Then starts:',
		thenMoves: 'Then moves:',
		/** Of devices for which there is no plan before the task is done. */
		mayMove: (who: string): string => `${who} may move as soon as this is done: keep clear.`,
		next: 'Next for you:',
	},
	problem: {
		more: 'More about it',
		title: (task: string): string => `What keeps you from “${task}”?`,
		means: 'Somebody comes. The task stays yours; nothing stops.',
		tell: 'Tell the station'
	}
};
