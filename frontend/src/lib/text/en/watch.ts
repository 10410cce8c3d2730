/** The watch, and tasks wherever they are shown. */
export const watch = {
	/** What this page is called, and the one to which who may goes on. */
	page: 'Operator view',
	operate: 'Operate',
	forYou: 'For you',
	nothingToDo: 'Nothing to do',
	nothingWhenHeard: 'Nothing when last heard',
	nothingKnown: 'Nothing is known of your tasks',
	operatorSays: 'An operator says when it is done.',
	done: 'Done',
	/** In its place where nothing comes of it. */
	record: 'Record as done',
	/** What a picture shows, for who does not see it. */
	shown: (title: string): string => `How it is done: ${title}`,
	sent: 'Sent',
	gone: 'This task is gone.',
	movesNext: 'Moves next:',
	moreAfter: (n: number): string => `${n} more after this`,
	waits: (duration: string): string => `Waits ${duration}`,
	/** Instead of what moves next, where nothing does. */
	nothingMoves: 'Nothing starts yet. Done is recorded.',
	/** The same in two parts, the second where there is room. */
	still: 'Nothing starts yet.',
	recorded: 'Done is recorded.',
	/** With nothing to do. */
	progress: (done: number, all: number): string => `${done} of ${all} done`,
	awaitsOrder: 'The station waits for an order.',
	/** What devices do meanwhile. */
	doing: (what: string): string => `Under way: ${what}`,
	comes: 'Your next task comes here.',
	/** What the plan has for somebody next, and in how many seconds. */
	next: (title: string, seconds: number | null): string =>
		// What does not break stays on one line of a small face.
		seconds === null ? `Next: ${title}` : seconds < 1 ? `${title} soon` : `${title} in\u00a0about\u00a0${seconds < 60 ? `${seconds}\u00a0s` : `${Math.round(seconds / 60)}\u00a0min`}`,
	/** Beside what is wrong. */
	goThere: 'Help is needed at the station.',
	/** Of an alarm, when it came. */
	called: (stopped: boolean, clock: string): string => `${stopped ? 'Stopped' : 'Help is needed'} since ${clock}.`,
	/** That one has seen an alarm; the second where there is room. */
	seen: 'Seen',
	iGo: ', I go there',
	/** Behind an alarm. */
	taskWaits: (title: string): string => `Your task “${title}” waits.`,
	toTask: 'To my task',
	/** Why nothing starts by itself. */
	standing: {
		preparing: 'Getting ready',
		waiting: 'Production is not started',
		held: 'Held: keep clear',
		restart: 'Restart: keep clear',
		paused: 'Paused',
		stopped: 'Stopped: help is needed'
	},
	silent: (titles: string): string => `No contact: ${titles}`,
	failing: (titles: string): string => `Needs help: ${titles}`,
	problem: 'Problem',
	/** What a person says is in the way, with one touch. */
	wrong: 'What’s wrong?',
	wrongs: { missing: 'Part missing', damaged: 'Damaged', tool: 'Tool', other: 'Other' },
	back: 'Back',
	solved: 'Solved',
	told: 'The station is told.',
	problemOf: (name: string): string => `${name} has a problem with it`,
	notLive: 'Not live',
	notLiveSince: (clock: string): string => `Not live since ${clock}`,
	causes: {
		connecting: 'Connecting to the station.',
		closed: 'The connection to the server is lost. Trying again.',
		controller: 'The server does not hear the controller.',
		gap: 'A message was lost on the way.',
		silent: 'Nothing new has come from the server.'
	},
	/** How the pages look, and in which language. */
	display: 'Display',
	soundOn: 'Sound on',
	soundOff: 'Sound off',
	/** Which screen this watch has, for who wears it to say. */
	shapes: { round: 'For a round screen', square: 'For a square screen' },
	signIn: 'Sign in',
	pairing: {
		title: 'Pair this watch',
		code: (digits: number): string => `Code of ${digits} digits`,
		pair: 'Pair',
		where: 'The code is on the page Wearables.',
		waiting: 'Waiting',
		confirmBefore: 'Confirm',
		confirmAfter: 'on the station’s page.',
		ended: 'Revoked or expired',
		endedWhy: (name: string): string => `This device is no longer the watch ${name}. Pair it again.`,
		unconfirmed: 'Not confirmed',
		unconfirmedWhy: (name: string): string => `${name} was refused, or two minutes went by. Ask for a new code.`
	}
};
