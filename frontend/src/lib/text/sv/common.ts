import type { Text } from '../text.svelte.ts';

export const common: Text['common'] = {
	product: 'Sequence Planner',
	old: 'gammalt',
	live: 'direkt',
	now: 'nu',
	cancel: 'Avbryt',
	close: 'Stäng',
	sending: 'Skickar',
	done: 'Gjort',
	reason: 'Skäl',
	optional: '(om du vill)',
	unknown: 'okänt',
	yes: 'ja',
	no: 'nej',
	none: 'Inga',
	takeControlFirst: 'Ta kontrollen först.',
	notLive: 'Inte direkt: vänta tills stationen hörs igen.',
	more: (n) => `${n} till`,
	language: 'Språk',
	theme: (theme) => `Tema: ${theme}`,
	themes: { auto: 'auto', light: 'ljust', dark: 'mörkt' },
	themeMeans: 'Tema: auto, ljust eller mörkt',
	time: {
		ms: (n) => `${n} ms`,
		s: (n) => `${String(n).replace('.', ',')} s`,
		min: (n) => `${n} min`,
		h: (n) => `${n} h`,
		days: (n) => `${n} dygn`,
		justNow: 'just nu',
		ago: (span) => `för ${span} sedan`,
		before: (span) => `${span} tidigare`
	}
};
