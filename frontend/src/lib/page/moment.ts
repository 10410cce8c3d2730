/** How moments of the calendar are said; all are seconds since the epoch, told in this device's time zone. */
import { ageText } from '#lib/wording/time.ts';

const DAY = new Intl.DateTimeFormat('en-GB', { day: 'numeric', month: 'short', year: 'numeric' });
const TIME = new Intl.DateTimeFormat('en-GB', { hour: '2-digit', minute: '2-digit', second: '2-digit' });

/** `22 Nov 2026`. */
export function dayText(seconds: number): string {
	return DAY.format(seconds * 1000);
}

/** `22 Nov 2026, 14:02:11`. */
export function momentText(seconds: number): string {
	return `${dayText(seconds)}, ${TIME.format(seconds * 1000)}`;
}

/** How long ago `moment` was at `now`: `just now`, `5 min ago`; never, when there was none. */
export function sinceText(moment: number | null, now: number): string {
	if (moment === null) return 'never';
	return now - moment < 60 ? 'just now' : `${ageText((now - moment) * 1000)} ago`;
}

/** How much is left at `now` until `moment`: `5 h left`, `less than a minute left`. */
export function leftText(moment: number, now: number): string {
	const left = moment - now;
	return left < 60 ? 'less than a minute left' : `${ageText(left * 1000)} left`;
}
