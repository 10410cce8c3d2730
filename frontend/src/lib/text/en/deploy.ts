import { count } from '../count.ts';

/** Deploy: revisions of the model, their differences, and which of them runs. */
export const deploy = {
	lookOn: (role: string): string => `As ${role} you can look on and compare. Engineers save, take back and deploy.`,
	notRead: 'The revisions are being read.',
	notLive: 'Not live: wait until the draft is heard again.',
	toModel: 'To the model',
	toCheck: 'To Check',
	toOperate: 'To Operate',

	draft: {
		title: 'The draft',
		after: (number: number): string => `After its change ${number}`,
		last: (title: string, by: string, clock: string): string => `${title} (${by}, ${clock})`,
		same: 'The station runs this draft.',
		differs: (n: number): string => `It differs from what runs in ${count(n, 'file', 'files')}:`,
		state: { new: 'new', changed: 'changed', removed: 'removed', same: 'the same' },
		saved: (name: string): string => `Saved as “${name}”.`,
		unsaved: 'Not saved as a revision.',
		save: 'Save revision…',
		deploy: 'Deploy…',
		compare: 'Compare with what runs'
	},

	revisions: {
		title: 'Revisions',
		none: 'No revision has been saved yet',
		howYet: 'Save the draft as one: it can be compared, deployed and gone back to from here.',
		unnamedRuns: 'What runs is none of these.',
		name: 'Revision',
		message: 'Message',
		by: 'Saved by',
		time: 'When',
		acts: 'Acts',
		runs: 'runs',
		draft: 'draft',
		compare: 'Compare…',
		back: 'Back to this revision…'
	},

	save: {
		title: 'Save the draft as a revision',
		name: 'Name',
		nameHint: 'Short, and of no other revision: up to 100 characters.',
		message: 'Message',
		word: 'Save',
		done: (name: string): string => `“${name}” is saved.`,
		wrong: {
			empty: 'It needs a name.',
			long: 'The name is longer than 100 characters.',
			taken: (name: string): string => `There is a revision “${name}” already: choose another name.`,
			same: (name: string): string => `Nothing differs from the revision “${name}”, the last that was saved.`
		}
	},

	back: {
		title: (name: string): string => `Back to “${name}”?`,
		means: 'The draft becomes this revision. Nothing that runs is touched.',
		undone: 'It is one change of the draft, and can be undone in Model like any other.',
		unsaved: 'What the draft is now is saved as no revision: Undo is the only way back to it.',
		word: 'Take it back',
		done: (name: string): string => `The draft is “${name}” again. It is being checked.`
	},

	compare: {
		over: (index: string): string => `for ${index}`,
		expanded: 'Written out',
		title: 'Compare',
		old: 'Older',
		new: 'Newer',
		running: 'what runs',
		draft: 'the draft',
		swap: 'Swap',
		word: 'Compare',
		equal: 'Choose two that are not the same.',
		asking: 'Being compared. It takes some seconds.',
		since: (seconds: number): string => `${seconds} s`,
		of: (old: string, newer: string): string => `From ${old} to ${newer}`,
		outdated: 'One of them has changed since: compare again.',
		nothing: 'They do not differ.',
		behaviour: 'Behaviour',
		text: 'Text',
		obstacle: 'Their behaviour cannot be compared:',
		sameBehaviour: 'They behave the same.',
		before: 'Before',
		after: 'After',
		part: 'What',
		nothingSaid: 'nothing',
		state: { new: 'new', gone: 'gone', changed: 'changed' },
		mark: { new: '+', gone: '−', changed: '≠' },
		counted: (news: number, gone: number, changed: number): string => `${news} new, ${gone} gone, ${changed} changed`,
		kind: {
			variable: 'Variables',
			ability: 'Abilities',
			effect: 'Effects',
			operation: 'Operations',
			specification: 'Specifications',
			station: 'Station'
		} as Readonly<Record<string, string>>,
		parts: {
			kind: 'kind',
			values: 'values',
			initial: 'initial value',
			enabled: 'enabled',
			start: 'may start when',
			'start actions': 'at the start',
			executing: 'executes while',
			finished: 'is finished when',
			finish: 'finishes when',
			'finish actions': 'at the finish',
			cancel: 'when cancelled',
			'added by the supervisor': 'added by the supervisor',
			restart: 'for restart only',
			task: 'task',
			when: 'when',
			does: 'does',
			takes: 'takes',
			precondition: 'precondition',
			goal: 'goal',
			local: 'local specification',
			priority: 'priority',
			forbidden: 'forbidden',
			'states of rest': 'states of rest'
		} as Readonly<Record<string, string>>,
		abilities: 'What can start where it could not, or no longer can',
		gained: 'Only in the newer one it can start',
		lost: 'Only in the older one it can start',
		fromBeginning: 'from the beginning.',
		run: (n: number): string => `after ${count(n, 'start', 'starts')}:`,
		plans: 'Plans of operations from the initial state',
		noPlan: 'no plan',
		starts: (n: number): string => count(n, 'start', 'starts'),
		file: (path: string): string => `Differences in ${path}`,
		lines: (added: number, taken: number): string => `+${added} −${taken}`,
		line: { old: 'Line before', new: 'Line after', sign: 'Sign', text: 'Text' },
		added: 'added',
		taken: 'taken away',
		skipped: (n: number): string => `${count(n, 'line', 'lines')} the same`,
		noNewline: 'no new line at the end',
		all: (n: number): string => `Show all ${n} lines`,
		more: (n: number): string => `Show all ${n}`
	},

	dialog: {
		title: 'Deploy the draft',
		titleOf: (name: string): string => `Deploy “${name}”`,
		needs: 'What it needs',
		met: 'done',
		missing: 'missing',
		need: {
			saved: 'The draft is saved as a revision.',
			other: 'It differs from what runs.',
			checked: 'It is checked, without errors and with a supervisor.',
			standing: 'Nothing starts by itself: the station is paused, held, in restart, or waits for its start; and no plan of a person is on its way.',
			control: 'You have control.',
			fits: 'The station’s state is safe in the new model, and what still runs is the same there.'
		},
		fitsReset: 'The state in which the simulation begins is safe in the new model.',
		differs: 'See what differs',
		stillRuns: 'What was begun still runs and may finish:',
		errand: 'A plan of a person is on its way: stop it on Restart, or wait until it has ended.',
		toRestart: 'To Restart',
		fit: {
			later: 'It is looked at once the draft is checked.',
			asking: 'It is being looked at. It takes some seconds.',
			again: 'Look again',
			moved: 'The station or the draft has moved since.',
			violated: 'In its present state it would violate',
			underWay: 'Of what still runs this is another one in the new model. Wait until it has finished:',
			noRest: 'From its present state nothing could come to rest there.',
			ways: 'Ways into the safe states:',
			noWay: 'No way into the safe states is known. Bring the devices to another state, or change the model.',
			obstacle: 'It cannot be known:'
		},
		changes: 'What does not go on as it is',
		goesOn: 'All variables go on as they are.',
		change: {
			new: 'new',
			gone: 'gone',
			anew: 'begins again'
		},
		to: (before: string, after: string): string => `${before} → ${after}`,
		begins: (value: string): string => `begins as ${value}`,
		was: (value: string): string => `was ${value}`,
		means: {
			keep: 'The controller restarts with this model. What was believed comes back as far as it fits, nothing is sent to devices, and a person starts production. You keep control. If the model cannot be started, the one before comes back.',
			reset:
				'The controller restarts with this model, and everything begins as the model says: what runs now does not go on. Nothing is sent to devices, and a person starts production. You keep control. If the model cannot be started, the one before comes back.'
		},
		simulation: {
			title: 'Emulated devices',
			keep: 'They go on as they stand.',
			reset: 'Reset the simulation: devices, outputs and estimates begin as the model says.'
		},
		sure: (name: string): string => `I want “${name}” to take the place of what runs.`,
		confirm: 'Confirm that you want it.',
		missingStill: (n: number): string => `${count(n, 'thing is', 'things are')} missing.`,
		word: 'Deploy'
	},

	progress: {
		title: (name: string): string => `“${name}” is being deployed`,
		titleRuns: (name: string): string => `“${name}” runs`,
		steps: {
			sent: 'Sent',
			accepted: 'Accepted: its files are in place',
			anew: 'The controller begins again',
			runs: 'The station runs it'
		},
		is: { done: 'done', now: 'now', later: 'to come' },
		titleUndone: (name: string): string => `“${name}” could not be started`,
		late: 'It takes longer than usual. What the server prints says why.',
		next: 'Nothing is sent to devices yet: start production on Operate.',
		undone: 'The model before is back, and the draft is as you deployed it: change it and deploy it again, or start production as before.',
		close: 'Put away'
	}
};
