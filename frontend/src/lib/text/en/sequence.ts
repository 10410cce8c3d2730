/** The page that shows operations in their order. */
import { count } from '../count.ts';

export const sequence = {
	loading: 'The operations are being read.',
	label: 'Operations in their order',
	keys: 'The arrow keys lead to the next operation in that direction, Home and End to the first and the last. Enter leads to what is said of it, Escape back.',
	view: 'Shown as',
	views: { sequence: 'Sequence', time: 'Gantt', table: 'Table' },
	said: (n: number, masters: readonly string[]): string =>
		masters.length === 0 ? count(n, 'operation', 'operations') : `${count(n, 'operation', 'operations')} · ${masters.join(', ')}`,
	add: 'Operation',
	unusable: 'The draft cannot be used as it is. This is the order as it was before; it cannot be edited here until that is mended.',
	toModel: 'To the problems',
	none: 'There are no operations',
	noneHow: 'An operation says what is to be reached and when that is wanted. Add one on the page Model, in operations.yaml.',
	chosen: 'The chosen operation',
	noLane: 'Station',
	by: (lane: string): string => `Done by ${lane}`,
	isNew: 'not in the station yet',
	ofDraft: 'draft',
	took: (time: string): string => `took ${time}`,
	tookLast: (time: string): string => `Took ${time} the last time`,
	inModel: (file: string, line: number): string => `${file}, line ${line}`,
	begins: 'Begins when',
	turns: 'Its turn, as sequences say',
	ends: 'Is done when',
	always: 'Always.',
	plan: 'How the plan does it',
	conditions: { so: 'holds', not: 'does not hold', open: 'not known', expression: 'As an expression' },
	order: {
		before: 'Comes after',
		after: 'Comes before',
		noneBefore: 'Nothing has to be done first.',
		noneAfter: 'Nothing waits for it.',
		again: 'from the round before',
		chance: 'one of several will do',
		bySequence: (name: string): string => `sequence ${name}`,
		byMaster: (title: string): string => `work master “${title}”`,
		itself: 'An operation cannot come after itself.',
		already: (before: string, after: string): string => `“${after}” comes after “${before}” already.`,
		circle: (before: string, after: string): string => `“${before}” comes before “${after}” already: with an arrow back neither could begin.`,
		drawn: (before: string, after: string): string => `In the draft “${after}” comes after “${before}” now`,
		erased: (before: string, after: string): string => `In the draft “${after}” no longer comes after “${before}”`,
		inModel: 'Change it on Model',
		erase: (before: string, after: string): string => `Take out: “${after}” comes after “${before}”`,
		putBehind: 'Let it come after',
		put: 'Add',
		how: 'Not offered is what comes after it already. Or draw an arrow in the picture, from the dot at the right of one operation to another. It is written as a sequence in operations.yaml, and runs after a deployment.'
	},
	together: {
		title: 'Together with others',
		kinds: { sequence: 'In sequence', parallel: 'At once', arbitrary: 'Any order', alternative: 'One of them' },
		how: {
			sequence: 'One after another, as they are numbered',
			parallel: 'All of them; none waits for another',
			arbitrary: 'All of them, one at a time; as they are numbered where several could begin',
			alternative: 'Only one of them: the first, as they are numbered, that can begin'
		},
		of: (kind: string, titles: readonly string[]): string => `${kind}: ${titles.join(', ')}`,
		bar: 'Put them together',
		more: 'One picked. Shift and a press, or Shift and Space, picks another',
		picked: (n: number): string => `${n} picked`,
		isPicked: ', picked',
		none: 'Pick none',
		keys: 'Shift and Space picks several, to put them together.',
		ordered: (before: string, after: string): string => `“${after}” waits for “${before}” already. Take that order out first: then they can be put together otherwise.`,
		already: (kind: string, name: string): string => `Some of them are put together already, in “${name}”: ${kind}. Change it there, on Model.`,
		written: (kind: string, titles: readonly string[]): string => `In the draft now ${kind.toLowerCase()}: ${titles.join(', ')}`
	},
	time: {
		none: 'Nothing is under way',
		noneHow: 'As soon as an operation is active, this shows when it began and when it is expected to be done.',
		bar: (title: string, standing: string, worked: string, waited: string): string => `${title}: ${standing}, ${worked} at work, ${waited} waiting`,
		legend: 'What is drawn how',
		tones: { past: 'Work done', run: 'Work under way', plan: 'Work planned', wait: 'Waits', fail: 'Stopped' }
	},
	table: { operation: 'Operation', by: 'Done by', standing: 'Now', took: 'Last time', oneOf: (names: readonly string[]): string => (names.length === 1 ? (names[0] ?? '') : `one of: ${names.join(', ')}`) }
};
