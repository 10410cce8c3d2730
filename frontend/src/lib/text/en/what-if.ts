import { count } from '../count.ts';

/** What if: simulating the draft of the model. */
export const whatIf = {
	title: 'What-if',
	simulated: 'Simulated. The station is not touched.',
	role: 'Only engineers simulate. Ask one of them.',
	from: 'Where it begins',
	present: 'The station as it is now',
	past: 'A record of its history',
	record: 'Number of the record',
	seconds: 'For how many seconds',
	go: 'Simulate',
	going: 'Simulating …',
	stop: 'Stop it',
	working: (passed: number, most: number): string =>
		`It has worked for ${count(passed, 'second', 'seconds')}. First it prepares the model; what it has simulated within ${most} s then is shown.`,
	result: 'What would happen',
	obstacle: (why: string): string => `Nothing could be simulated: ${why}`,
	done: (seconds: number, runs: number, operations: number): string =>
		`${count(Math.round(seconds), 'second', 'seconds')} simulated: ${count(runs, 'run', 'runs')} of abilities, ${count(operations, 'operation', 'operations')} completed.`,
	unsafe: 'It begins outside the safe states of this model, so operations start nothing.',
	unplanned: (why: string): string => `In the end: ${why}.`,
	operations: 'Operations',
	runs: 'Runs of abilities',
	ability: 'Ability',
	started: 'Starts after',
	ended: 'Ends after',
	goesOn: 'goes on',
	nothing: 'Nothing is started',
	completed: 'Operations completed',
	changes: 'Otherwise in the end'
};
