/** How spans of time are said: an *age* is how long ago something was, a *duration* how long it has lasted. */

/** Age in words, from milliseconds. Coarser as it grows, so that the figure stays calm. */
export function ageText(milliseconds: number): string {
	if (milliseconds < 1000) return `${Math.floor(milliseconds / 10) * 10} ms`;
	const seconds = milliseconds / 1000;
	if (seconds < 10) return `${(Math.floor(seconds * 10) / 10).toFixed(1)} s`;
	if (seconds < 120) return `${Math.floor(seconds)} s`;
	if (seconds < 7200) return `${Math.floor(seconds / 60)} min`;
	if (seconds < 172800) return `${Math.floor(seconds / 3600)} h`;
	return `${Math.floor(seconds / 86400)} days`;
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
	const whole = Math.max(0, Math.floor(seconds));
	if (live && whole === 0) return 'just now';
	return `${whole < 10 ? `${whole} s` : ageText(whole * 1000)} ${live ? 'ago' : 'before'}`;
}

const CLOCK = new Intl.DateTimeFormat('en-GB', { hour: '2-digit', minute: '2-digit' });
const DATED = new Intl.DateTimeFormat('en-GB', { day: 'numeric', month: 'short', hour: '2-digit', minute: '2-digit' });

/** When `moment` was (seconds, as `now`), as a clock shows it: `14:02`; with its day where that is not the one of `now`. */
export function clockText(moment: number, now: number): string {
	const [then, today] = [new Date(moment * 1000), new Date(now * 1000)];
	return (then.toDateString() === today.toDateString() ? CLOCK : DATED).format(then);
}
