/** The live picture of the station. */
export const mimic = {
	title: 'Station',
	inWords: 'in words',
	picture: (station: string): string => `Live picture of ${station}`,
	keys: 'Arrow keys go from one thing to the next, Enter shows it.',
	waits: 'The picture is being loaded.',
	noPicture: 'There is no picture of the station.',
	columns: { thing: 'Thing', now: 'Now', alarm: 'Alarm' },
	looks: { empty: 'empty', placed: 'placed', done: 'done', doubt: 'unknown' },
	towards: (stop: string): string => `→ ${stop}`,
	atWork: (stop: string, work: string): string => `${stop} · ${work}`,
	/** Of a person whom nothing is asked of. */
	free: 'Nothing to do',
	nothingMoves: 'Nothing is under way',
	unheard: (names: string, n: number): string => `Nobody knows whether ${names} ${n === 1 ? 'moves' : 'move'}`,
	failing: (names: string, n: number): string => `${names} ${n === 1 ? 'does' : 'do'} not go on`,
	nothingMovesAnd: (waits: string): string => `Nothing is under way · ${waits}`,
	then: (now: string, next: string): string => `${now}, then ${next}`,
	andMore: (named: string, more: number): string => `${named} and ${more} more`,
	unknownPlace: 'Nobody knows where it is',
	/** Of what is not heard, or at no known place. */
	last: (said: string, stop: string): string => `${said}, last: ${stop}`,
	/** Of what stands where an operation has stopped. */
	standsWaiting: 'waits',
	/** Of a device with an alarm that it does not do what it should. */
	stuck: 'Does not go on',
	/** Of one that moves all the same: nobody must take it for one that stands still. */
	movesStuck: (does: string): string => `${does}, does not go on`,
	between: 'Between two places',
	notHeard: 'Not heard',
	rests: 'Nothing runs',
	isThere: (thing: string): string => `${thing} is there`,
	isGone: (thing: string): string => `${thing} is not there`,
	unknownThing: (thing: string): string => `${thing}: unknown`,
	is: (name: string, value: string): string => `${name}: ${value}`,
	of: (value: number, most: number): string => `${value} of ${most}`,
	undrawn: (n: number): string => (n === 1 ? '1 thing of mimic.yaml is not drawn' : `${n} things of mimic.yaml are not drawn`),
	place: (file: string, line: number, column: number): string => `${file}, line ${line}, column ${column}`,
	thing: {
		out: 'out of service',
		awaits: 'Awaits',
		notConfirmed: 'not confirmed',
		forced: 'forced',
		restartOnly: 'restart mode only',
		alarms: 'Alarms',
		whatToDo: 'What to do',
		values: 'Values',
		noValues: 'It has no values.',
		abilities: 'Abilities',
		others: (n: number): string => (n === 1 ? '1 more that waits' : `${n} more that wait`),
		states: { running: 'runs', ready: 'can start', waits: 'waits', unknown: 'unknown' },
		moreValues: (n: number): string => `${n} more on State`,
		links: 'More about it',
		state: 'All values',
		history: 'History',
		alarmsPage: 'All alarms'
	}
};
