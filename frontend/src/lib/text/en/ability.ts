import { count } from '../count.ts';

/** An ability: its automaton, live, and a trial of it alone. */
export const ability = {
	now: 'now',
	restartOnly: 'in restart mode only',
	person: 'a person does it',
	place: (file: string, line: number): string => `${file}, line ${line}`,
	phases: {
		unknown: 'not known',
		idle: 'not enabled',
		enabled: 'enabled',
		started: 'started',
		executing: 'executing',
		finished: 'finished'
	},

	automaton: {
		title: 'Automaton',
		drawn: (title: string): string => `Automaton of ${title}`,
		becomesEnabled: 'is enabled when',
		start: 'Start',
		startWhen: 'starts, when it is its turn, if it is enabled and',
		startAlways: 'starts, when it is its turn, as soon as it is enabled',
		begins: 'is executing when',
		neverExecutes: 'It is never seen executing.',
		finish: 'Finish',
		finishWhen: 'finishes as soon as',
		atOnce: 'It is done at its start.',
		isFinished: 'is finished when',
		neverFinished: 'Nothing says that it is finished: it can be enabled again.',
		sets: 'then sets',
		setsNothing: 'sets nothing'
	},
	/** What comes about without anybody who starts it. */
	byItself: {
		title: 'By itself',
		finishes: 'finishes as soon as',
		now: 'holds now',
		whenever: 'It finishes whenever this holds, whether it was started or not:',
		reactions: (n: number): string => count(n, 'reaction of its device', 'reactions of its device')
	},
	part: {
		always: 'always',
		never: 'never',
		holds: 'holds',
		lacking: 'does not hold',
		open: 'not known',
		is: (name: string, value: string): string => `${name} is ${value}`
	},
	supervised: {
		title: 'The supervisor adds',
		about: 'Not written in the model: found by synthesis. It starts only if also',
		none: 'The supervisor adds nothing to this start.',
		pending: 'What the supervisor adds is still being computed.',
		noShort: 'There is no short expression for it: the states themselves say when.',
		blocked: 'Not, among others, where:',
		because: 'Because of:',
		rest: 'coming to rest again',
		allows: 'It would allow a start now.',
		forbids: 'It does not allow a start now.',
		open: 'Whether it would allow a start now is not known.'
	},
	reactions: {
		title: 'What its device is expected to do',
		none: 'Nothing is said of what its device does.',
		kinds: { starting: 'as it starts', executing: 'as it executes', finishing: 'after it has finished' } as Readonly<Record<string, string>>,
		when: 'when',
		changes: 'then',
		takes: (from: number, to: number): string => (from === to ? `in ${from} s` : `in ${from}–${to} s`),
		fault: 'fault',
		faultMeaning: 'It may happen; nobody counts on it.'
	},
	timeouts: {
		title: 'If it takes too long',
		react: (seconds: number): string => `not executing ${seconds} s after its start`,
		finish: (seconds: number): string => `not finished ${seconds} s after its start`,
		none: 'There is no limit: no alarm is raised, however long it takes.',
		alarm: 'There is an alarm, and it goes on.',
		replan: (retries: number): string =>
			retries === 0
				? 'There is an alarm, it is called off, and the plan goes on without it.'
				: `There is an alarm, it is called off and planned again, up to ${count(retries, 'time', 'times')}; then the plan goes on without it.`,
		cancel: 'Called off, it sets',
		noCancel: 'It does not say how it is called off: what runs goes on to its end.'
	},
	table: {
		title: 'As a table',
		part: 'Part',
		condition: 'Condition or action',
		now: 'Now',
		values: 'Values',
		where: 'Written in',
		parts: {
			enabled: 'Enabled',
			start: 'Start, guard',
			startActions: 'Start, actions',
			supervised: 'Start, supervisor',
			executing: 'Executing',
			finish: 'Finish, guard',
			finishActions: 'Finish, actions',
			finished: 'Finished',
			cancelActions: 'Called off, actions',
			reaction: (name: string): string => `Expected: ${name}`
		},
		done: 'set so',
		undone: 'set otherwise'
	},

	trial: {
		title: 'Try it',
		about: 'Starts this ability once and nothing else, under the same guards and the same supervisor as in production. The station stays paused.',
		engineer: 'An engineer can try an ability while the station is paused.',
		word: 'Try it',
		running: 'It is being tried.',
		other: 'Something else is being carried out.',
		hindered: 'It cannot be tried now:',
		stop: 'Stop the trial',
		stopMeaning: 'Ends the trial, and calls the ability off where it says how that is done.',
		real: {
			title: (title: string): string => `Try ${title} with real devices?`,
			warning: 'Real devices move. Nobody may be where they move, and somebody must be able to stop them at the station.',
			found: 'Seen on the network:',
			unseen: 'The station does not run with emulated devices.',
			sure: 'I have looked: the device may move.',
			confirm: 'Confirm that the device may move.',
			reason: 'Reason'
		},
		course: 'The last trial',
		by: (who: string, why: string): string => (why === '' ? `by ${who}` : `by ${who}: ${why}`),
		none: 'It has not been tried since the controller started.',
		steps: { sent: 'sent', accepted: 'accepted', started: 'started', executing: 'executing', finished: 'finished', ended: 'ended unfinished' },
		marks: { done: 'done', now: 'under way', ahead: 'to come', never: 'did not come' },
		because: (why: string): string => `It ended: ${why}.`,
		reactions: 'What its device did',
		reaction: {
			came: (after: string, expected: string): string => `came after ${after} (expected ${expected})`,
			due: (since: string): string => `expected since ${since}`,
			missing: 'did not come',
			untouched: 'had no reason to come',
			faultless: 'did not happen'
		},
		seconds: (s: string): string => `${s} s`
	}
};
