import { count } from '../count.ts';

/** The check of a draft: how it stands, and what it finds. */
export const check = {
	draft: (number: number): string => `The draft after its change ${number}`,
	last: (title: string, by: string, clock: string): string => `${title} (${by}, ${clock})`,
	verdict: {
		waiting: 'It will be checked in a moment.',
		checking: 'It is being checked.',
		failed: 'It could not be checked.',
		unusable: 'It cannot be used.',
		unmeetable: 'It has no supervisor: nothing of it could be started.',
		good: 'Checked. It can be used.'
	},
	/** The same in a line, beside when it was and how long it took. */
	line: {
		waiting: 'The check begins',
		checking: (what: string): string => `Checking: ${what}`,
		failed: (why: string): string => `Could not be checked: ${why}`,
		unusable: (errors: number): string => `Cannot be used: ${count(errors, 'error', 'errors')}`,
		unmeetable: 'No supervisor: nothing could start',
		good: 'Checked',
		took: (time: string): string => `in ${time}`
	},
	again: 'Change the model, and it is checked again.',
	stages: 'What it looks for',
	stage: {
		'reading it': 'Can it be read?',
		'the examples of pipelines': 'Do the examples of pipelines hold?',
		'what is suspicious': 'What is suspicious in it?',
		'the safe states': 'Which states are safe?',
		'the findings': 'What is never possible?',
		'the guards': 'What does the supervisor add?'
	},
	stageIs: { done: 'done', now: 'now', later: 'to come' },
	sizes: {
		abilities: (n: number): string => count(n, 'ability', 'abilities'),
		variables: (n: number): string => count(n, 'variable', 'variables'),
		operations: (n: number): string => count(n, 'operation', 'operations'),
		specifications: (n: number): string => count(n, 'specification', 'specifications')
	},

	findings: 'Findings',
	none: 'Nothing was found.',
	noneYet: 'Nothing has been found yet.',
	group: 'Grouped by',
	by: { severity: 'severity', kind: 'kind', file: 'file' },
	error: 'error',
	warning: 'warning',
	write: (name: string): string => `Write “${name}”`,
	open: (place: string): string => `${place} in the model`,
	showAll: (n: number): string => `Show all ${n}`,
	kinds: {
		'unusable': 'Errors',
		'specification-cannot-be-met': 'A specification that cannot be met',
		'never-allowed': 'Dead: kept from ever starting by the supervisor',
		'never-starts': 'Dead: never starts',
		'never-active': 'Dead: an operation that never becomes active',
		'goal-lost': 'A goal that the supervisor puts out of reach',
		'goal-out-of-reach': 'A goal that cannot be reached',
		'write-conflict': 'Two that write the same variable at once',
		'never-holds': 'Never holds',
		'always-holds': 'Always holds',
		'unreachable': 'Nothing makes it true',
		'relies-on-executing': 'A quick device would not be seen to finish',
		'effect-never-happens': 'Dead: an effect that never happens',
		'nothing-brings-about': 'No plan can use it',
		'nothing-feeds': 'Measured, and nothing feeds it',
		'carried-nowhere': 'An output that no topic carries',
		'never-written': 'Never written',
		'never-read': 'Never read',
		'never-used': 'A name that nothing uses',
		'shared-acknowledgement': 'One answer would end two tasks',
		'task-never-open': 'A task that nobody is asked to do',
		'forbids-nothing': 'A specification that forbids nothing',
		'empty-local-specification': 'A formula that reads no variable',
		'not-finished': 'Not computed in time',
		'too-many-states': 'Too many states to know',
		'more': 'More findings than are shown'
	} as Readonly<Record<string, string>>,

	trace: {
		fromBeginning: 'Show the state: it is so from the beginning',
		play: (n: number): string => `Play how it comes about, in ${count(n, 'step', 'steps')}`,
		away: 'Put it away',
		title: 'How it comes about',
		first: 'First',
		back: 'Back',
		next: 'Next',
		last: 'Last',
		step: 'Step',
		of: (step: number, all: number): string => `Step ${step} of ${all}`,
		beginning: 'The initial state',
		steps: 'Steps',
		what: {
			tick: 'The devices act',
			start: 'Start of',
			activity: 'Activity of',
			transition: 'Step'
		} as Readonly<Record<string, string>>,
		finished: 'Finished:',
		nothing: 'Nothing changes.',
		changes: (n: number): string => `${count(n, 'variable changes', 'variables change')}.`,
		forbidden: 'This state is forbidden by',
		values: 'Values after this step',
		variable: 'Variable',
		value: 'Value',
		changed: 'changed',
		shown: 'Variables shown',
		some: 'those that change on the way',
		all: 'all',
		ability: {
			title: 'An ability in this step',
			which: 'Ability',
			is: (title: string, phase: string): string => `${title}: ${phase}`,
			asking: 'The ability is looked at in each step …'
		}
	},

	supervisor: 'What the supervisor adds',
	adds: (n: number): string => `It adds to the guards of ${count(n, 'ability', 'abilities')}, each for the specifications that are named.`,
	addsNothing: 'It adds nothing: the guards as they are written keep the station in its safe states.',
	addsNothingTo: 'It adds nothing to this ability.',
	addsLater: 'It is not known yet.',
	noSupervisor: 'There is none.',
	starts: 'Ability',
	onlyWhen: 'May start only when',
	because: 'Because of',
	over: (index: string): string => `for ${index}`,
	rest: 'coming to rest again'
};
