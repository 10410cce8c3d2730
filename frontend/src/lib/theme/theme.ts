/**
 * Light, dark, or as the device says.
 *
 * The choice is kept in this browser. `static/theme.js` applies it before the first paint; it shares the names below.
 */
export const THEMES = ['auto', 'light', 'dark'] as const;
export type Theme = (typeof THEMES)[number];

const KEY = 'theme';

/** The theme that is kept; `auto` when none is or the browser keeps nothing. */
export function keptTheme(): Theme {
	const shown = document.documentElement.dataset['theme'];
	return THEMES.find((theme) => theme === shown) ?? 'auto';
}

/** Shows `theme` and keeps it. */
export function useTheme(theme: Theme): void {
	document.documentElement.dataset['theme'] = theme;
	try {
		localStorage.setItem(KEY, theme);
	} catch {
		// Storage may be forbidden; then the choice lasts as long as the page.
	}
}

/** The theme after `theme` when a person steps through them. */
export function following(theme: Theme): Theme {
	return THEMES[(THEMES.indexOf(theme) + 1) % THEMES.length] ?? 'auto';
}
