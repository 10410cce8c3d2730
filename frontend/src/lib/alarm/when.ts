/** How moments of an alarm are said. */

/** When `moment` was (seconds, as `now`): `14:02:11`, with its day where that is not the one of `now`. */
export function whenText(moment: number, now: number, locale: string): string {
	const [then, today] = [new Date(moment * 1000), new Date(now * 1000)];
	const time = { hour: '2-digit', minute: '2-digit', second: '2-digit' } as const;
	const day = then.toDateString() === today.toDateString() ? {} : ({ day: 'numeric', month: 'short' } as const);
	return new Intl.DateTimeFormat(locale, { ...day, ...time }).format(then);
}
