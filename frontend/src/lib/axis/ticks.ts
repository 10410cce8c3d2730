/** Where a time axis has its marks, and what they say. All are seconds. */

/** Steps that people count in. */
const STEPS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400];

/** The smallest step that leaves at most `most` (1 or more) marks on an axis of `length`; days where none does. */
export function stepOf(length: number, most: number): number {
	return STEPS.find((step) => length / step <= most) ?? Math.ceil(length / most / 86400) * 86400;
}

/** The marks from `from` to `to`, at most `most` and one: multiples of a step after `origin`. */
export function ticksOf(from: number, to: number, most: number, origin = 0): number[] {
	if (!(to > from)) return [];
	const step = stepOf(to - from, most);
	const first = Math.ceil((from - origin) / step);
	const last = Math.floor((to - origin) / step);
	return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => origin + (first + index) * step);
}

/** What a mark says that is so far from the present: `−20 s`, `+1 min`, `+1:30 min`. Empty for the present. */
export function distanceText(seconds: number): string {
	if (seconds === 0) return '';
	const sign = seconds < 0 ? '−' : '+';
	const whole = Math.abs(Math.round(seconds));
	if (whole < 60) return `${sign}${whole} s`;
	const [unit, size] = whole < 3600 ? ['min', 60] : ['h', 3600];
	const rest = Math.round((whole % size) / (size / 60));
	return `${sign}${Math.floor(whole / size)}${rest === 0 ? '' : `:${String(rest).padStart(2, '0')}`} ${unit}`;
}
