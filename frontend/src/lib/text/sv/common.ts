import type { Text } from '../text.svelte.ts';

export const common: Text['common'] = {
	product: 'Sequence Planner',
	noStation: 'Inget är känt om stationen än.',
	old: 'gammalt',
	live: 'direkt',
	now: 'nu',
	cancel: 'Avbryt',
	close: 'Stäng',
	sending: 'Skickar',
	reason: 'Skäl',
	unknown: 'okänt',
	yes: 'ja',
	no: 'nej',
	none: 'Inga',
	takeControlFirst: 'Ta kontrollen först.',
	notLive: 'Inte direkt: vänta tills stationen hörs igen.',
	more: (n) => `${n} till`,
	language: 'Språk'
};
