import { count } from '../count.ts';

/** Restart. */
export const restart = {

	/** The short notice on Operate. */
	notice: {
		wanted: 'Needs you',
		go: 'To Restart',
		acts: { choose: 'Choose a way back', decide: 'Decide on the outputs', answer: 'Answer the questions', start: 'Start production', goOn: 'Go on' },
		reasons: {
			restart: 'The station is in restart mode.',
			hold: 'The station is held.',
			paused: 'The station is paused.',
			productDone: (who: string, why: string): string => `The product is done, and the station is paused, as ${who} asked${why === '' ? '.' : `: ${why}`}`,
			atBreakpoint: (condition: string, who: string): string => `The station is paused at a breakpoint of ${who}: ${condition}.`,
			undecided: (n: number): string => `${count(n, 'output', 'outputs')} from before the start ${n === 1 ? 'waits' : 'wait'} for a decision.`,
			questions: (n: number): string => `${count(n, 'question', 'questions')}: what is believed does not fit what is measured.`,
			unconfirmed: 'The station believes things that nobody has confirmed yet.',
			outside: 'The station is outside its safe states.',
			unsure: 'Safety unknown.',
			noPlan: 'There is no plan for what is to be done.',
			outOfService: (what: string): string => `Out of service: ${what}.`,
			alarm: (n: number): string => `${count(n, 'alarm lasts', 'alarms last')}.`,
			errand: 'What a person has taken is carried out.'
		}
	},

	/** What a person does next. */
	next: {
		title: 'Next',
		live: 'Wait until the station is heard again.',
		preparing: 'Wait until the station is prepared.',
		errand: 'Wait until what was taken has ended, or stop it.',
		decide: 'Decide on the outputs that came back.',
		answer: 'Look at the station, and say what is so.',
		enter: 'Enter restart mode.',
		start: 'Start production.',
		physical: 'Do it at the station, then check again.',
		take: 'Take a way back.',
		check: 'Check the product: what is left to propose only says what is true of it.',
		leave: 'Ready to go on: leave restart mode.',
		continue: 'Continue.',
		stuck: 'No way back is known: see why, and put right what is in the way.',
		looking: 'Wait for the ways back.',
		look: 'See to what the alarms say; the station goes on as far as it can.',
		nothing: 'Nothing: the station works by itself.',
		viewer: 'An operator gets the station back to work.'
	},

	steps: {
		label: 'Restart in four steps',
		titles: { understand: 'Understand', state: 'Make the state true', ways: 'Choose a way back', on: 'Go on' },
		done: 'done',
		still: 'All devices stand still.',
		unheard: (names: string, n: number): string => `Nobody knows whether ${names} ${n === 1 ? 'moves' : 'move'}.`,
		moving: (names: string): string => `Not finished: ${names}.`,
		questions: (n: number): string => `${count(n, 'question', 'questions')} to answer.`,
		outputs: (n: number): string => `${count(n, 'output', 'outputs')} to decide on.`,
		confirm: 'Look whether it is still as before.',
		/** Before what has changed without a command. */
		afterHand: 'Look whether what the station believes is still true.',
		said: (by: string, at: string, what: string): string => `${by} said at ${at}: ${what}.`,
		ways: (n: number): string => `${count(n, 'way', 'ways')}, least effort first.`,
		one: 'One way.',
		none: 'No way is known yet.',
		checked: (n: number): string => `${count(n, 'way', 'ways')}, only if you have checked.`,
		nothing: 'Nothing has to be carried out.',
		leftOut: (n: number): string => `${count(n, 'operation', 'operations')} to which no plan leads from here.`,
		afterwards: 'The ways follow from it.',
		taken: (title: string, at: string): string => `${title}, done at ${at}.`,
		runs: (title: string): string => `${title} is carried out.`,
		/** Before what a person sees to. */
		beforeGoingOn: 'Before you go on:',
		works: 'Then production goes on by itself.',
		notLive: 'Not known until the station is heard again.',
		to: (number: number, title: string): string => `To step ${number}: ${title}`,
		first: (title: string): string => `First: ${title}`,
		calm: 'The station works by itself',
		calmAbout: 'When it stops, this page leads back to production: understand, make the state true, choose a way back, go on.',
		look: 'Show the steps'
	},


	happened: {
		title: 'What happened',
		none: 'No alarms.',
		alarms: 'Alarms',
		outside: 'Outside the safe states',
		violated: 'Violated:',
		threatened: 'Could come about without any start:',
		safe: 'How the nearest safe state differs',
		unwatched: 'Until it is back in them the supervisor holds nothing back: watch what moves first.',
		instead: (name: string, safe: string, now: string): string => `${name} is ${safe}, not ${now}`,
		corrected: (by: string, at: string, what: string): string => `Corrected by ${by} at ${at}: ${what}`,
		history: 'See in History',
		lasting: (duration: string): string => `for ${duration}`,
		over: (at: string): string => `over since ${at}, not acknowledged`
	},
	/** What a person sees to before the station goes on. */
	first: {
		title: 'Before you go on',
		done: 'Done',
		by: (who: string): string => `${who} has seen to it`
	},
	moves: {
		title: 'What has not finished',
		clear: 'It may move at any moment: keep clear.',
		nothing: 'Nothing is running.',
		since: (duration: string): string => `for ${duration}`,
		person: 'a person does it'
	},
	errand: {
		title: 'Under way',
		over: 'What was done',
		begins: 'It begins.',
		from: 'Looking for what comes next.',
		until: 'until',
		taken: (by: string, ago: string, why: string): string => `${by} took it ${ago} ago: ${why}`,
		stop: 'Stop it',
		stopMeaning: 'Running steps finish. Nothing more of it starts.',
		done: (at: string): string => `Done at ${at}:`,
		/** What it was for is so, before it is at its end. */
		reached: (at: string): string => `It has brought about at ${at} what it was for:`,
		stillMoves: (names: string, n: number): string => `${names} still ${n === 1 ? 'moves' : 'move'}: keep clear until it stands still`,
		ended: (at: string): string => `Ended before it was done, at ${at}:`
	},

	believed: {
		looked: 'I have looked',
		title: 'Believed and measured',
		besides: 'Something else',
		agree: 'The state fits every measurement.',
		agreeHeard: 'The state fits all that is heard.',
		ask: (so: string): string => `Is it true that ${so}?`,
		askAll: 'Is all of this true?',
		seen: 'Seen at the station',
		seenOnly: 'Confirm only what you have seen.',
		why: 'The station believes so, and it does not fit what is measured.',
		whyAll: 'The station believes so, and not all of it fits what is measured.',
		corrected: 'Corrected last',
		change: 'Correct it again',
		correct: 'Correct something',
		correctMeaning: 'Is something not as the station believes? Correct it here, or press it in the picture.',
		otherwise: 'Correct something else',
		otherwiseMeaning: 'Is anything else not as the station believes? Correct it here, or press it in the picture.',
		first: 'A correction needs restart mode. Operations wait in it, and running steps finish.',
		firstControl: 'To say what is so needs control.',
		so: (value: string): string => `Yes, ${value}`,
		soAll: 'Yes, all of it',
		other: (value: string): string => `It is ${value}`,
		more: (n: number): string => `Then ${count(n, 'more question', 'more questions')}. With each answer there may be fewer.`,
		answered: (name: string, value: string, by: string, at: string): string =>
			`${name} is ${value}, ${by} said at ${at}. What is measured does not fit that: something has been done by hand, or is measured wrongly.`,
		by: (writer: string, at: string): string => `by ${writer}, ${at}`,
		unconfirmed: 'Not confirmed yet',
		look: 'The station believes this, and nobody has seen yet whether it is true. Look whether it is so:',
		all: 'Confirm all of it',
		one: 'Confirm'
	},

	outputs: {
		title: 'Outputs to decide on',
		why: 'These commands are from before the controller started. As soon as they are sent their devices react:',
		decide: 'Decide',
		dialog: 'Which values shall be sent?',
		nothing: 'Nothing is sent by this. It is when production is started.',
		each: 'Choose a value for each.',
		stays: 'its device stays as it is',
		before: 'as before: its device reacts',
		unsafe: 'alone, it would lead out of the safe states'
	},

	ways: {
		title: 'Ways back',
		looking: 'Looking for ways.',
		again: 'The station has changed. Looking again.',
		kept: 'The station has changed.',
		retry: 'Not answered: it is asked again by itself.',
		lookAgain: 'Look again',
		found: 'All ways were looked for; there are no others.',
		noneFits: 'None of these fits…',
		gone: 'The way that you had chosen is no longer offered.',
		choose: 'Choose a way to see what happens then.',
		least: 'Recommended',
		during: 'While something is carried out nothing else is offered.',
		operator: 'An operator is shown the ways back.',
		unfinished: 'Still looking: there may be better ways.',
		incomplete: 'The search ended early; there may be better ways.',
		none: 'There is no way back from this state.',
		noneFound: 'No way back was found in the time there is; that there is none is not proven.',
		noneToDo: 'Nothing that devices or people could do from here is known to lead back.',
		nothingElse: 'All ways were looked for.',
		whyUnknown: (operations: readonly string[]): string =>
			`Why was not found in the time there is.${operations.length === 0 ? '' : ` From here nothing leads to: ${operations.join(', ')}.`}`,
		byHand: 'What the plan cannot do a person may do by hand. Do it at the station, then correct what the station believes.',
		tasksMeaning: 'It is corrected, and so counts as done, as soon as you confirm that you have done it.',
		ifChecked: 'Only if you have checked',
		ifCheckedMeaning: 'Each of these says that something is not as the station believes, and nothing that it knows speaks for that. Take one only if you have seen that it is so.',
		onlyIf: (claims: string): string => `Already so: ${claims}`,
		records: (values: string): string => `Then the station notes that ${values}.`,
		claims: (titles: string): string => `It would count as done, or nearer to it: ${titles}.`,
		kinds: {
			replan: 'goes on by itself',
			restart: 'in restart mode',
			reset: 'reset',
			correction: 'correction',
			physical: 'by hand',
			combined: 'by hand, then in restart mode',
			'way-back': 'back to safety',
			goal: 'a goal by hand'
		},
		starts: (n: number): string => count(n, 'start', 'starts'),
		seconds: (n: number): string => `≈ ${n} s`,
		minutes: (n: number, seconds: number): string => (seconds === 0 ? `≈ ${n} min` : `≈ ${n} min ${seconds} s`),
		rest: 'ends at rest',
		restMeaning: 'It ends in a safe state of rest, the best place to begin from again.',
		outside: 'starts outside the safe states',
		more: (n: number): string => `${n} more`,
		goals: (titles: string): string => `Then the station goes on: ${titles}.`,
		goalsPlain: 'Then the station goes on.',
		waitsOnly: 'The devices do it by themselves.',
		intoSafe: 'It brings the station back into its safe states.',
		hand: 'Nothing by hand',
		you: (n: number): string => `You, ${count(n, 'step', 'steps')}`,
		corrections: (n: number, what: string): string => `${count(n, 'correction', 'corrections')}: ${what}`,
		proven: 'Proven',
		/** Of a plan that counts on what is not heard. */
		provenIf: 'Proven if nothing has changed',
		/** Of one that corrects something. */
		provenIfSo: 'Proven if it is so',
		provenMeaning: 'Taken step by step from the state as it is, to a plan for what is to be done.',
		unproven: 'Not proven',
		outsideShort: 'Starts outside the safe states',
		leftOutShort: (n: number): string => `Gives up ${count(n, 'operation', 'operations')}`,
		first: 'You do first',
		see: (so: string): string => `See to it that ${so}.`,
		now: (value: string): string => `(now: ${value})`,
		online: (title: string): string => `Bring ${title} back.`,
		waits: 'The station notices it by itself.',
		senseless: 'It is heard, but not understood. The station notices once it is.',
		outBecause: (why: string): string => `It is out of service: ${why}`,
		back: 'It is back.',
		service: (title: string): string => `Look after “${title}”, then put it back into service.`,
		putBack: 'Put back',
		putBackTitle: (title: string): string => `Put ${title} back into service?`,
		assumed: 'Planned as if nothing has changed since it was last heard:',
		is: (name: string, value: string): string => `${name} is ${value}`,
		correct: 'Only if it is so at the station',
		breaks: 'On its way this is violated, which is not now:',
		leftOut: 'Gives up:',
		done: 'Done, check again',
		/** Said to whoever has pressed that, where it is not so yet. */
		still: {
			checked: (what: string): string => `Checked: ${what}.`,
			awaited: (title: string): string => `${title} is still not heard`,
			senseless: (title: string): string => `${title} is still not understood`,
			out: (title: string): string => `${title} is still out of service`,
			other: (so: string, now: string): string => `it is not so yet that ${so} ${now}`
		},
		holdFirst: 'Hold the station first. If you do not, it moves by itself as soon as this is done. Held, it may have other ways back.',
		hold: 'Hold the station',
		goOn: 'Nothing has to be carried out.'
	},
	plan: {
		title: 'What happens then',
		ends: (time: string): string => `ends after ${time}`,
		/** Below the time of a way itself. */
		inAll: (time: string): string => `${time} with what follows`,
		endsSafe: (time: string): string => `ends after ${time}, in a safe state`,
		movesFirst: 'moves first',
		nothing: 'Nothing is sent. The devices do it by themselves.',
		/** Of what is to be brought about, and holds. */
		already: 'It is so already. Nothing has to be started, and nothing waited for.',
		until: 'until',
		safe: 'the station is back in its safe states',
		and: 'and',
		then: (goals: string): string => `Then, in automatic mode: ${goals}`,
		thenPlain: 'Then, in automatic mode',
		stepByStep: 'Step by step',
		unknown: 'What the station does after that is not known.',
		none: 'Nothing has to be started for it.',
		length: (starts: number): string => count(starts, 'start', 'starts'),
		minimal: 'the fewest possible',
		person: 'a person',
		restart: 'restart ability',
		steps: 'Steps'
	},
	take: {
		only: 'Only this is carried out. Restart mode stays on.',
		onlyPaused: 'Only this is carried out. The station stays paused.',
		onlyCorrects: 'No start. Only what the station believes is changed.',
		until: 'It ends when',
		haveRead: (n: number): string => (n === 1 ? 'This start may be carried out.' : `All ${n} starts may be carried out.`),
		nobodyIn: (device: string, what: string, n: number): string =>
			`Nobody reaches in: ${device} moves first (${what}). ${n === 1 ? 'This start' : `All ${n} starts`} may be carried out.`,
		mayWait: 'I will wait for it.',
		haveSeen: (so: string): string => `I have looked: ${so}.`,
		confirm: 'Confirm what is above.',
		moved: 'The station has changed. Check the ways again.',
		fresh: 'Check again',
		note: 'Note for the journal',
		why: 'Why this way? (optional)',
		noNote: 'Taken on the page Restart, without a note',
		word: 'Take this way',
		enter: 'Restart mode is needed for it. The ways are looked for again then.'
	},

	byHand: {
		title: 'None of these fits',
		/** Where there are none. */
		others: 'Something else…',
		about: 'You see the plan to what you ask for before anything starts.',
		reset: 'Reset an operation',
		resetMeaning: 'The station is brought to where the operation begins, and it begins again.',
		operation: 'Operation',
		active: 'active',
		plan: 'Find a plan',
		whyNot: 'Why not?',
		goal: 'A goal by hand',
		goalMeaning: 'What must be so, as an expression of the model.',
		predicate: 'Predicate',
		engineer: 'An engineer can bring the station to a goal by hand.',
		finding: 'Looking',
		offered: 'Found.',
		correct: 'Correct the state by hand',
		correctMeaning: 'If something is not as the station believes, and none of the ways says so.',
		enterMeaning: 'Operations wait, and you decide what starts.'
	},
	why: {
		title: (title: string): string => `Why not: ${title}`,
		reasons: 'As long as all of this stays as it is there is no way:',
		corrections: 'There would be one with:',
		plan: 'The station could reach it:'
	},

	acts: {
		first: 'First',
		/** To which no plan leads. */
		leftOut: (titles: string): string => `No plan leads to this from here: ${titles}. The station goes on without, and stands when nothing else is to be done.`,
		/** What one does, to be said after another: take control, leave restart mode and continue. */
		words: {
			control: 'take control',
			enter: 'enter restart mode',
			leave: 'leave restart mode',
			start: 'start production',
			go: 'continue'
		},
		/** Said of what was done, where the next one was refused. */
		done: {
			control: 'You have control.',
			enter: 'The station is in restart mode.',
			leave: 'The station is paused.',
			start: 'Production is started.',
			go: 'The station goes on.'
		},
		then: 'Then it stopped:',
		meaning: {
			enter: 'Operations wait, running steps finish. Nothing new starts.',
			leave: 'The station is paused then. Nothing starts.',
			start: 'From then on commands are sent to the devices.',
			startNow: 'Commands are sent to the devices, and the station works at once.',
			go: 'Operations go on.'
		},
		title: 'Go on',
		alone: (n: number): string => (n === 1 ? 'Or only a part of it' : 'Or only one part of it'),
		/** Where the station goes on by itself: what can be done in place of that. */
		instead: 'Instead',
		works: 'Nothing to press here: production is started and goes on by itself.',
		preparing: 'The station is still getting ready.',
		decideFirst: 'Decide on the outputs first.',
		errandFirst: 'Something is being carried out.'
	}
};
