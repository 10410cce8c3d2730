/** How spans of time are said: an *age* is how long ago something was, a *duration* how long it has lasted. */
import { say } from '#lib/text/text.svelte.ts';

/** Age in words, from milliseconds. Coarser as it grows, so that the figure stays calm. */
export function ageText(milliseconds: number): string {
	const { ms, s, min, h, days } = say().common.time;
	if (milliseconds < 1000) return ms(Math.floor(milliseconds / 10) * 10);
	const seconds = milliseconds / 1000;
	if (seconds < 10) return s((Math.floor(seconds * 10) / 10).toFixed(1));
	if (seconds < 120) return s(Math.floor(seconds));
	if (seconds < 7200) return min(Math.floor(seconds / 60));
	if (seconds < 172800) return h(Math.floor(seconds / 3600));
	return days(Math.floor(seconds / 86400));
}

/** Duration as a clock shows it, from seconds: `0:07`, `1:02:03`. Clocks that disagree by a moment show 0:00. */
export function durationText(seconds: number): string {
	const whole = Math.max(0, Math.floor(seconds));
	const pair = (n: number): string => String(n).padStart(2, '0');
	const [hours, minutes, rest] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
	return hours > 0 ? `${hours}:${pair(minutes)}:${pair(rest)}` : `${minutes}:${pair(rest)}`;
}

/** When something was, in whole seconds or coarser: `just now`, `12 s ago`; told from an old view, `12 s before`. */
export function agoText(seconds: number, live: boolean): string {
	const { s, justNow, ago, before } = say().common.time;
	const whole = Math.max(0, Math.floor(seconds));
	if (live && whole === 0) return justNow;
	return (live ? ago : before)(whole < 10 ? s(whole) : ageText(whole * 1000));
}

const TIME = { hour: '2-digit', minute: '2-digit' } as const;
const formats = new Map<string, { readonly clock: Intl.DateTimeFormat; readonly dated: Intl.DateTimeFormat }>();

/** Made once for each language: they are dear. */
function formatsOf(locale: string): { readonly clock: Intl.DateTimeFormat; readonly dated: Intl.DateTimeFormat } {
	let made = formats.get(locale);
	if (made === undefined) {
		const dated = new Intl.DateTimeFormat(locale, { day: 'numeric', month: 'short', ...TIME });
		formats.set(locale, (made = { clock: new Intl.DateTimeFormat(locale, TIME), dated }));
	}
	return made;
}

/** When `moment` was (seconds, as `now`), as a clock shows it: `14:02`; with its day where that is not the one of `now`. */
export function clockText(moment: number, now: number): string {
	const [then, today] = [new Date(moment * 1000), new Date(now * 1000)];
	const { clock, dated } = formatsOf(say().locale);
	return (then.toDateString() === today.toDateString() ? clock : dated).format(then);
}
