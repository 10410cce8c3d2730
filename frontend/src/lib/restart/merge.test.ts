import { expect, test } from 'vitest';
import type { AdviceAnswer, WayOffer } from '#lib/contract.ts';
import { offer } from '#lib/testing/offer.ts';
import { merged } from './merge.ts';

const MOVE = offer({ id: 'life-1', title: 'Move' });
const RUN = offer({ id: 'life-2', title: 'Run' });
const HANDS = offer({ id: 'life-3', title: 'By hand', online: ['robot'] });
const CHECKED = offer({ id: 'life-4', title: 'Checked', only_if_checked: true });
const WHY = { members: [], member_messages: [], corrections: [], correction_messages: [], minimal: true };

function answer(offers: WayOffer[], rest: Partial<AdviceAnswer> = {}): AdviceAnswer {
	return { revision: 7, offers, if_checked: [], reasons: null, complete: true, seconds: 0.1, ...rest };
}

const SHORT = { complete: false };
const titles = ({ offers }: AdviceAnswer): string[] => offers.map(({ title }) => title);

test('a search that was cut short takes nothing away that was found for the same state', () => {
	const both = answer([MOVE, RUN], { if_checked: [CHECKED] });
	const after = merged(both, answer([], { ...SHORT, reasons: WHY }));
	expect(titles(after)).toEqual(['Move', 'Run']);
	expect(after.if_checked).toEqual([CHECKED]);
	expect([after.complete, after.reasons]).toEqual([false, null]);
});

test('what it found itself comes first, in its order, and nothing twice', () => {
	const again = { ...RUN, id: 'life-9' };
	const after = merged(answer([MOVE, RUN], SHORT), answer([HANDS, again], SHORT));
	expect(titles(after)).toEqual(['By hand', 'Run', 'Move']);
	expect(after.offers[1]).toBe(again);
});

test('a complete answer replaces all, and so does one for another state', () => {
	expect(titles(merged(answer([MOVE], SHORT), answer([RUN])))).toEqual(['Run']);
	expect(titles(merged(answer([MOVE]), answer([], { ...SHORT, revision: 8 })))).toEqual([]);
	expect(titles(merged(null, answer([RUN], SHORT)))).toEqual(['Run']);
});

test('why there is none is still said where none is kept', () => {
	expect(merged(answer([], SHORT), answer([], { ...SHORT, reasons: WHY })).reasons).toBe(WHY);
});
