import { expect, test } from 'vitest';
import { offer, preview } from '#lib/testing/offer.ts';
import { en } from '#lib/text/en.ts';
import { asksForHands, canBeTaken, goesOn, mayBeWanted, onlySays } from './offer.ts';
import { effortWords, kindWord } from './offer-words.ts';

const CHANGE = { name: 'b', now: 'placed', then: 'empty' };

test('an offer is to be taken, done by hand, or nothing but going on: one of these', () => {
	const asked = (each: ReturnType<typeof offer>): boolean[] => [asksForHands(each), canBeTaken(each), goesOn(each)];
	expect(asked(offer())).toEqual([false, false, true]);
	expect(asked(offer({ errand: preview() }))).toEqual([false, true, false]);
	expect(asked(offer({ corrections: [CHANGE] }))).toEqual([false, true, false]);
	expect(asked(offer({ online: ['robot'], corrections: [CHANGE] }))).toEqual([true, false, false]);
	expect(asked(offer({ in_service: ['move'] }))).toEqual([true, false, false]);
	expect(asked(offer({ physical: [CHANGE], errand: preview('move') }))).toEqual([true, false, false]);
});

test('what only says what is true of the product is never shown as what to do', () => {
	expect(onlySays(offer({ corrections: [CHANGE] }))).toBe(true);
	expect(onlySays(offer({ corrections: [CHANGE], errand: preview('move') }))).toBe(false);
	expect(mayBeWanted(offer({ corrections: [CHANGE] }))).toBe(false);
	expect(mayBeWanted(offer({ corrections: [CHANGE], errand: preview('move') }))).toBe(false);
	expect(mayBeWanted(offer({ errand: preview('move') }))).toBe(true);
});

test('what it takes is said, and what it does not take is not', () => {
	const { ways } = en.restart;
	const effort = { cost: 9, corrections: 1, physical: 0, returns: 0, starts: 2, seconds: 8.2 };
	expect(effortWords(ways, effort)).toEqual(['1 change', '2 starts', '≈ 9 s']);
	expect(effortWords(ways, { ...effort, corrections: 0, starts: 0, seconds: 0, returns: 1 })).toEqual(['1 brought back']);
});

test('a kind has a word, whether this page knows it or not', () => {
	expect(kindWord(en.restart.ways, 'way-back')).toBe('back to safety');
	expect(kindWord(en.restart.ways, 'toString')).toBe('toString');
});
