/** What is said before anybody is let in, and wherever the server refuses or is not reached. */
export const door = {
	connecting: 'Connecting',
	notLive: 'Not live.',
	tryingAgain: 'Trying again.',
	toStation: 'To the station',
	notFound: {
		title: 'Not found',
		noPage: 'There is no such page',
		failed: 'This page failed'
	},
	/** Where the page was opened: of the station nothing is told before somebody is signed in. */
	at: (host: string): string => `Station at ${host}`,
	or: 'or',
	signIn: {
		title: 'Sign in',
		under: 'Signing in',
		missing: 'Name and password are both needed.',
		help: 'No name yet, or the password forgotten? Ask an administrator of this station.',
		pair: 'Pair a watch'
	},
	provider: {
		title: (provider: string): string => `Sign in with ${provider}`,
		under: (provider: string): string => `Going to ${provider}`,
		finishing: (provider: string): string => `${provider} has answered. Signing in`,
		finishingAny: 'The provider has answered. Signing in',
		back: 'Back to sign-in',
		signOut: (provider: string): string => `Sign out of ${provider} as well`,
		stillThere: (provider: string): string =>
			`You are signed out here, but perhaps not at ${provider}. On a device that others use, sign out there too.`
	},
	name: { label: 'Name', missing: 'Enter your name.' },
	password: {
		label: 'Password',
		missing: 'Enter your password.',
		show: 'Show',
		hide: 'Hide',
		capsLock: 'Caps Lock is on.',
		missingAbove: 'Something is missing above.',
		rules: (shortest: number): string =>
			`At least ${shortest} characters, such as a few words; without the name, and not one character over and over.`,
		short: (length: number, shortest: number): string =>
			`The password has ${length} characters; it needs at least ${shortest}.`,
		long: (length: number, longest: number): string =>
			`The password has ${length} characters; at most ${longest} are kept.`,
		named: 'The password contains the name.',
		repeated: 'The password is one character over and over.'
	},
	demonstration: {
		about: 'A demonstration on emulated devices. It needs no name.',
		open: 'Open the demonstration'
	},
	first: {
		noAdministrator: 'This station has no administrator yet.',
		how: 'How somebody becomes one',
	},
	refusal: {
		notSent: 'Not sent',
		notSentWhy: 'The server cannot be reached. Look at the station before you try again.',
		noAnswer: 'No answer',
		noAnswerWhy: 'The server did not answer in time, and whether it was done is not known. Look at the station before you try again.',
		notRead: 'Not read',
		notReached: 'The server cannot be reached.',
		refused: 'Refused',
		status: (status: number): string => `The server answered with status ${status}.`,
		again: (wait: string): string => `Try again in ${wait}.`,
		againNow: 'You can try again now.'
	}
};
