import { expect, test } from 'vitest';
import { offer, preview } from '#lib/testing/offer.ts';
import { en } from '#lib/text/en.ts';
import { asksForHands, canBeTaken, goesOn, mayBeWanted, onlySays } from './offer.ts';
import { handsOf, kindWord, resourcesOf, timeWords } from './offer-words.ts';

const CHANGE = { name: 'b', now: 'placed', then: 'empty', so: { id: 'as-it-was', arguments: { text: 'b is empty' } } };

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

test('how long it takes is said as people say it', () => {
	const { ways } = en.restart;
	const said = (seconds: number): string => timeWords(ways, seconds);
	expect([8.2, 59.2, 80, 119.5, 660].map(said)).toEqual(['≈ 9 s', '≈ 1 min', '≈ 1 min 20 s', '≈ 2 min', '≈ 11 min']);
});

test('what a person does by hand is counted, before it and within it', () => {
	const { steps, ...rest } = preview('move', 'place');
	const errand = { ...rest, steps: steps.map((step) => ({ ...step, human: step.ability === 'place' })) };
	expect(handsOf(offer({ errand }))).toBe(1);
	expect(handsOf(offer({ errand, physical: [CHANGE], online: ['robot'] }))).toBe(3);
	expect(resourcesOf(offer({ errand }))).toEqual(['robot']);
	expect(handsOf(offer())).toBe(0);
});

test('a kind has a word, whether this page knows it or not', () => {
	expect(kindWord(en.restart.ways, 'way-back')).toBe('back to safety');
	expect(kindWord(en.restart.ways, 'toString')).toBe('toString');
});
