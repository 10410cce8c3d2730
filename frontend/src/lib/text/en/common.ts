/** What more than one room says. */
export const common = {
	product: 'Sequence Planner',
	old: 'old',
	live: 'live',
	now: 'now',
	cancel: 'Cancel',
	close: 'Close',
	sending: 'Sending',
	done: 'Done',
	reason: 'Reason',
	optional: '(optional)',
	unknown: 'unknown',
	yes: 'yes',
	no: 'no',
	none: 'None',
	takeControlFirst: 'Take control first.',
	notLive: 'Not live: wait until the station is heard again.',
	more: (n: number): string => `${n} more`,
	language: 'Language',
	theme: (theme: string): string => `Theme: ${theme}`,
	themes: { auto: 'auto', light: 'light', dark: 'dark' },
	themeMeans: 'Theme: auto, light or dark',
	/** How spans of time are said; what is before `justNow` are units. */
	time: {
		ms: (n: number): string => `${n} ms`,
		s: (n: string | number): string => `${n} s`,
		min: (n: number): string => `${n} min`,
		h: (n: number): string => `${n} h`,
		days: (n: number): string => `${n} days`,
		justNow: 'just now',
		ago: (span: string): string => `${span} ago`,
		before: (span: string): string => `${span} before`
	}
};
