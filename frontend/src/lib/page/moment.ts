/** How moments of the calendar are said; all are seconds since the epoch, told in this device's time zone. */
import { say } from '#lib/text/text.svelte.ts';
import { ageText } from '#lib/wording/time.ts';

const DAY: Intl.DateTimeFormatOptions = { day: 'numeric', month: 'short', year: 'numeric' };
const TIME: Intl.DateTimeFormatOptions = { hour: '2-digit', minute: '2-digit', second: '2-digit' };
/** What formats them, by language: made once for each, as tables ask for it in every row. */
const formats = new Map<string, { readonly day: Intl.DateTimeFormat; readonly time: Intl.DateTimeFormat }>();

function format(): { readonly day: Intl.DateTimeFormat; readonly time: Intl.DateTimeFormat } {
	const { locale } = say();
	const found = formats.get(locale) ?? {
		day: new Intl.DateTimeFormat(locale, DAY),
		time: new Intl.DateTimeFormat(locale, TIME)
	};
	formats.set(locale, found);
	return found;
}

/** `22 Nov 2026`. */
export function dayText(seconds: number): string {
	return format().day.format(seconds * 1000);
}

/** `22 Nov 2026, 14:02:11`. */
export function momentText(seconds: number): string {
	return `${dayText(seconds)}, ${format().time.format(seconds * 1000)}`;
}

/** How long ago `moment` was at `now`: `just now`, `5 min ago`; never, when there was none. */
export function sinceText(moment: number | null, now: number): string {
	if (moment === null) return say().account.moment.never;
	return now - moment < 60 ? say().account.moment.justNow : say().account.moment.ago(ageText((now - moment) * 1000));
}

/** How much is left at `now` until `moment`: `5 h left`, `less than a minute left`. */
export function leftText(moment: number, now: number): string {
	const left = moment - now;
	return left < 60 ? say().account.moment.almost : say().account.moment.left(ageText(left * 1000));
}
