import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { AdviceAnswer } from '#lib/contract.ts';
import { offer } from '#lib/testing/offer.ts';
import { goesOnLooking, isDue, isSettled, type Asked } from './due.ts';

const answer: AdviceAnswer = { revision: 7, offers: [offer()], if_checked: [], reasons: null, complete: true, seconds: 0.1 };
const asked = (over: Partial<Asked> = {}): Asked => ({ answer, refused: false, times: 1, since: 3000, ...over });

describe('ways back are asked for', () => {
	test('at first, and as soon as the state has moved', () => {
		expect(isDue(asked({ answer: null, since: Infinity }), 7)).toBe(true);
		expect(isDue(asked(), 8)).toBe(true);
		expect(isDue(asked(), 7)).toBe(false);
	});

	test('again where no answer came', () => expect(isDue(asked({ refused: true }), 7)).toBe(true));

	test('now and then in the same state, since time alone can tell of a device that does nothing more', () => {
		expect(isDue(asked({ since: 11_000 }), 7)).toBe(true);
	});

	test('a few times more where the time was too short', () => {
		const short = { ...answer, offers: [], complete: false };
		expect(isDue(asked({ answer: short, times: 1 }), 7)).toBe(true);
		expect(isDue(asked({ answer: short, times: 3, since: 11_000 }), 7)).toBe(false);
		expect(isDue(asked({ answer: short, times: 3, since: 31_000 }), 7)).toBe(true);
	});

	test('so too where something to do was found in it: what is best may be missing yet', () => {
		const short = { ...answer, complete: false };
		expect([isDue(asked({ answer: short, times: 1 }), 7), goesOnLooking(short, 1)]).toEqual([true, true]);
		expect([isDue(asked({ answer: short, times: 3 }), 7), goesOnLooking(short, 3)]).toEqual([false, false]);
		expect(isSettled(short, 1)).toBe(true); // meanwhile it can be taken
		expect(goesOnLooking(answer, 1)).toBe(false);
	});

	test('so too where only corrections were found in it, and now and then after that', () => {
		const guesses = { ...answer, offers: [offer({ corrections: [{ name: 'b', now: 'placed', then: 'empty', so: { id: 'as-it-was', arguments: { text: 'b is empty' } }, by_hand: null }] })] };
		const short = { ...guesses, complete: false };
		expect(isDue(asked({ answer: short, times: 1 }), 7)).toBe(true);
		expect(isDue(asked({ answer: short, times: 3 }), 7)).toBe(false);
		expect(isDue(asked({ answer: short, times: 3, since: 31_000 }), 7)).toBe(true);
		expect(isDue(asked({ answer: guesses, times: 1 }), 7)).toBe(false);
		expect([isSettled(short, 1), isSettled(short, 2), isSettled(guesses, 1)]).toEqual([false, true, true]);
	});

	test('never sooner than 2 s after the last answer', () => {
		fc.assert(
			fc.property(fc.nat(1999), fc.boolean(), fc.nat(), fc.nat(), (since, refused, times, revision) => {
				expect(isDue(asked({ since, refused, times }), revision)).toBe(false);
			})
		);
	});
});
