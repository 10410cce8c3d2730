import { expect, test } from 'vitest';
import type { Figures } from '#lib/contract.ts';
import { cycleLevel, first, madeLevel, orderOf, percentText, worked } from './told.ts';

const AT = '2026-06-01T08:00:00Z';

function figures(rest: Partial<Figures> = {}): Figures {
	const made = { count: 0, planned: null, by_now: null, by_order: 0, to_make: 0 };
	return { time: 100, time_at: AT, day: 0, day_at: AT, in_work: [], made, cycle: null, availability: null, shift: null, next_shift: null, ...rest };
}

function product(job: string | null, began: number): Figures['in_work'][number] {
	return { job, title: `Engine ${job}`, work_master: 'engine', began, began_at: AT, expected_end: null, expected_end_at: null };
}

test('of several products the one that was begun first is told', () => {
	expect(first(figures({ in_work: [product('b', 7), product('a', 3)] }))?.job).toBe('a');
	expect(first(figures())).toBeUndefined();
	expect(first(null)).toBeUndefined();
});

test('which order of today is in work is counted as on Orders: without what was made freely and what may not start', () => {
	// Two of the three were made freely, and one of the five is not released.
	const made = { count: 3, planned: 5, by_now: 3, by_order: 1, to_make: 3 };
	expect(orderOf(figures({ made, in_work: [product('a', 3)] }))).toEqual({ n: 2, all: 4 });
	expect(orderOf(figures({ made }))).toBeNull();
	expect(orderOf(figures({ made, in_work: [product(null, 3)] })), 'it is no order').toBeNull();
	// It is over since.
	expect(orderOf(figures({ made: { ...made, to_make: 0 }, in_work: [product('a', 3)] }))).toBeNull();
});

test('what is made is compared with what is due, and with nothing where nothing is', () => {
	expect(madeLevel(figures({ made: { count: 7, planned: 20, by_now: 10, by_order: 5, to_make: 15 } }))).toEqual({ part: 0.25, mark: 0.5 });
	expect(madeLevel(figures())).toBeNull();
	expect(madeLevel(figures({ made: { count: null, planned: null, by_now: null, by_order: 0, to_make: 0 } }))).toBeNull();
	expect(madeLevel(null)).toBeNull();
});

test('the median has its place on the bar however long a product takes', () => {
	expect(cycleLevel(50, 100)).toEqual({ part: 0.4, mark: 0.8 });
	expect(cycleLevel(400, 100)).toEqual({ part: 1, mark: 0.25 });
	expect(cycleLevel(0, 0)).toEqual({ part: 0, mark: 0 });
});

test('a share is told as people of the language write it', () => {
	expect(percentText(0.9421, 'en-GB')).toBe('94.2');
	expect(percentText(1, 'sv-SE')).toBe('100,0');
});

const EARLY = { name: 'early', title: { en: 'Early shift', sv: 'Förmiddag' }, begins: 0, begins_at: AT, ends: 28_800, ends_at: AT };
const DAY = { since: 10, since_at: AT, share: 0.5, counted: 400, available: 200, trend: [] };

test('the availability is that of the shift that is on, be it known or not', () => {
	const trend = [{ time: 600, time_at: AT, share: 1 }];
	const availability = { ...DAY, share: 0.9, trend };
	const found = worked(figures({ availability: DAY, shift: { ...EARLY, made: 3, availability }, next_shift: EARLY }), 100);
	expect(found.head).toBe('Available · Early shift');
	expect(found.times).toMatch(/^Early shift, \d\d:\d\d to \d\d:\d\d$/);
	expect(found.figure).toEqual({ since: 10, share: 0.9, trend: [1, 0.9] });
	const unknown = { ...EARLY, made: null, availability: null };
	expect(worked(figures({ availability: DAY, shift: unknown, next_shift: EARLY }), 100).figure, 'it is not that of the day').toBeNull();
});

test('outside of a shift it is that of the day, and it is said that there is none now', () => {
	const found = worked(figures({ availability: DAY, next_shift: EARLY }), 100);
	expect(found.head).toBe('Available today · no shift now');
	expect(found.times).toMatch(/^No shift is on. Next: Early shift, /);
	expect(found.figure?.share).toBe(0.5);
	expect(worked(figures({ availability: DAY }), 100)).toMatchObject({ head: 'Available today', times: null });
	expect(worked(null, 100).figure).toBeNull();
	expect(worked(figures({ availability: { ...DAY, counted: 2 } }), 100).figure, 'of two seconds it says nothing').toBeNull();
});
