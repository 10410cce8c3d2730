/** How a wait is said that the server asks for. */

/** `40 s`, `1 min 5 s`, `2 h`, from whole seconds; coarser as it grows. */
export function waitText(seconds: number): string {
	if (seconds < 60) return `${seconds} s`;
	if (seconds >= 7200) return `${Math.ceil(seconds / 3600)} h`;
	const [minutes, rest] = [Math.floor(seconds / 60), seconds % 60];
	return rest === 0 ? `${minutes} min` : `${minutes} min ${rest} s`;
}

/** Whole seconds that are left at `now` until `end` (both milliseconds of one clock); never less than 0. */
export function secondsLeft(end: number, now: number): number {
	return Math.max(0, Math.ceil((end - now) / 1000));
}
