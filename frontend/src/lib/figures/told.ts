/** What the figures of the day and the shift come to, for the strip and for the wall. */
import type { Figures } from '#lib/contract.ts';
import { inLanguage, language, say } from '#lib/text/text.svelte.ts';
import { clockText, durationText } from '#lib/wording/time.ts';

/** The product in work for which figures are shown: the one that was begun first. */
export function first(figures: Figures | null): Figures['in_work'][number] | undefined {
	return figures?.in_work.toSorted((a, b) => a.began - b.began)[0];
}

/** Which order of today the one in work is, of those that are made and may start, as Orders counts them; null without one. */
export function orderOf(figures: Figures | null): { readonly n: number; readonly all: number } | null {
	const made = figures?.made;
	return made && first(figures)?.job && made.to_make > 0 ? { n: made.by_order + 1, all: made.by_order + made.to_make } : null;
}

export interface Level {
	/** From 0 to 1. */
	readonly part: number;
	/** Where the mark is. */
	readonly mark: number;
}

/** How many of the orders of today are made; null where none is due. */
export function madeLevel(figures: Figures | null): Level | null {
	const made = figures?.made;
	if (!made || made.planned === null || made.by_now === null || made.planned === 0) return null;
	return { part: made.by_order / made.planned, mark: made.by_now / made.planned };
}

/** How long this product takes beside how long they do, of which a quarter more still has room. */
export function cycleLevel(seconds: number, median: number): Level {
	const whole = Math.max(seconds, median * 1.25, 1);
	return { part: seconds / whole, mark: median / whole };
}

/** How long an order took, or takes so far: it has no end yet. */
export interface OrderCycle {
	readonly id: string;
	readonly title: string;
	/** When it was made, in seconds. */
	readonly ended: number | null;
	readonly seconds: number;
}

/** The median of those that are made: a new one says nothing yet. */
export function medianOf(cycles: readonly OrderCycle[]): number {
	const made = cycles.filter(({ ended }) => ended !== null).map(({ seconds }) => seconds).sort((a, b) => a - b);
	return ((made[Math.floor((made.length - 1) / 2)] ?? 0) + (made[Math.floor(made.length / 2)] ?? 0)) / 2;
}

/** By how much more or less than `median`, in whole seconds: `+0:07`. */
export function against(seconds: number, median: number): string {
	const more = Math.round(seconds) - Math.round(median);
	return more === 0 ? '±0:00' : (more > 0 ? '+' : '−') + durationText(Math.abs(more));
}

/** A share as people say it, with a decimal: `94.2`. */
export function percentText(share: number, locale: string): string {
	return (share * 100).toLocaleString(locale, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
}

/** How long the station worked of what it was to, and of which time. */
export interface Worked {
	/** Whose time it is: the shift's, or the day's. */
	readonly head: string;
	/** From when to when the shift lasts, or when the next one begins; null where the station has no shifts. */
	readonly times: string | null;
	/** Null where nobody knows. */
	readonly figure: { readonly since: number; readonly share: number; readonly trend: readonly number[] } | null;
}

/** Seconds: of fewer a share says nothing. */
export const LEAST = 15;

/** The availability of the shift that is on, or else of the day; times are told as seen `now`. */
export function worked(figures: Figures | null, now: number): Worked {
	const texts = say().figures;
	const title = (shift: NonNullable<Figures['next_shift']>): string => inLanguage(shift.title, language());
	const [on, next] = [figures?.shift, figures?.next_shift];
	const found = on ? on.availability : figures?.availability;
	const figure = found && found.counted >= LEAST && { since: found.since, share: found.share, trend: [...found.trend.map(({ share }) => share), found.share] };
	if (on) {
		const times = texts.shiftTimes(title(on), clockText(on.begins, now), clockText(on.ends, now));
		return { head: texts.availableIn(title(on)), times, figure: figure || null };
	}
	return {
		head: next ? texts.noShift : texts.available,
		times: next ? texts.nextShift(title(next), clockText(next.begins, now)) : null,
		figure: figure || null
	};
}

/** How many are made: of the orders that are due today, or else all, for an order or freely. */
export function madeText(made: Figures['made'], texts: { today: (n: number) => string; byOrder: (n: number, planned: number) => string }): string {
	return made.planned === null ? texts.today(made.count ?? 0) : texts.byOrder(made.by_order, made.planned);
}
