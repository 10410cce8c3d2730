/** How moments of the past are said in the language of the page, in this device's time zone. */
import { stepOf, ticksOf } from './ticks.ts';
import { say } from '#lib/text/text.svelte.ts';
import type { Window } from './window.ts';

const DAY = { day: 'numeric', month: 'short', year: 'numeric' } as const;
const CLOCK = { hour: '2-digit', minute: '2-digit', second: '2-digit' } as const;
const known = new Map<string, Intl.DateTimeFormat>();

/** Made once for each language, which takes longer than to use it. */
function format(name: string, options: Intl.DateTimeFormatOptions): Intl.DateTimeFormat {
	const key = `${say().locale} ${name}`;
	const found = known.get(key) ?? new Intl.DateTimeFormat(say().locale, options);
	known.set(key, found);
	return found;
}

/** `14:02:11`. */
export function clockText(seconds: number): string {
	return format('clock', CLOCK).format(seconds * 1000);
}

/** `22 Nov 2026, 14:02:11`. */
export function whenText(seconds: number): string {
	return `${format('day', DAY).format(seconds * 1000)}, ${clockText(seconds)}`;
}

export interface AxisMark {
	readonly at: number;
	readonly text: string;
}

/** The marks of the axis of `window`, at most `most` and one, at round times of this device's day. */
export function axisOf(window: Window, most: number): AxisMark[] {
	const midnight = new Date(window.from * 1000).setHours(0, 0, 0, 0) / 1000;
	const step = stepOf(window.to - window.from, most);
	const text = (at: number): string => {
		if (step >= 86_400) return format('date', { day: 'numeric', month: 'short' }).format(at * 1000);
		return step < 60 ? clockText(at) : format('minute', { hour: '2-digit', minute: '2-digit' }).format(at * 1000);
	};
	return ticksOf(window.from, window.to, most, midnight).map((at) => ({ at, text: text(at) }));
}
