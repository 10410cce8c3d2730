import { expect, test } from 'vitest';
import type { AdviceAnswer, Question, WayOffer } from '#lib/contract.ts';
import { offer, preview } from '#lib/testing/offer.ts';
import { estimate } from '#lib/testing/view.ts';
import { choiceOf, waysOf, type Choice, type Way } from './choice.ts';

const MOVE = offer({ id: 'life-1', kind: 'restart', title: 'Move to the pose above the engine', errand: preview('move') });
const RUN = offer({ id: 'life-2', kind: 'restart', title: 'Run the nutrunner', errand: preview('run') });
const SAYS = offer({ id: 'life-3', corrections: [{ name: 'b', now: 'placed', then: 'empty', so: { id: 'as-it-was', arguments: { text: 'b is empty' } }, by_hand: null }] });

const DOUBT: Question = { variable: 'b', believed: 'placed', so: { id: 'as-it-was', arguments: { text: 'b is placed' } }, possible: ['empty'], because: [], because_messages: [] };
const answerOf = (...offers: WayOffer[]): AdviceAnswer => ({ revision: 7, offers, if_checked: [], reasons: null, complete: true, seconds: 0 });

function ways(...offers: WayOffer[]): readonly Way[] {
	return waysOf(answerOf(...offers), { questions: [DOUBT], variables: {} }).offered;
}

const picked = (wanted: WayOffer, ...offers: WayOffer[]): string | null => ways(...offers).find(([, each]) => each === wanted)?.[0] ?? null;
const title = ({ chosen, lost }: Choice): string | null => (lost ? 'lost' : (chosen?.[1].title ?? null));

test('the first is chosen as long as nobody has, unless it only says what is so', () => {
	expect(title(choiceOf(ways(RUN, MOVE), null))).toBe(RUN.title);
	expect(title(choiceOf(ways(SAYS, MOVE), null))).toBe(null);
	expect(title(choiceOf(ways(), null))).toBe(null);
});

test('what a person has chosen stays the chosen one, wherever and under whatever number it is found again', () => {
	const key = picked(MOVE, MOVE, RUN);
	const again = { ...MOVE, id: 'life-9', revision: 8, errand: preview('back', 'move') };
	expect(choiceOf(ways(RUN, again), key).chosen?.[1]).toBe(again);
});

test('where it is gone that is said, and no other is chosen', () => {
	const key = picked(MOVE, MOVE, RUN);
	expect(title(choiceOf(ways(RUN), key))).toBe('lost');
	expect(choiceOf(ways(RUN), key).chosen).toBe(null);
	// Of the same title, with something else to be done by hand.
	expect(title(choiceOf(ways({ ...MOVE, online: ['robot'] }), key))).toBe('lost');
});

test('ways of one meaning are told apart', () => {
	const keys = ways(MOVE, { ...MOVE, id: 'life-4' }, RUN).map(([key]) => key);
	expect(new Set(keys).size).toBe(3);
});

test('what nothing speaks against is corrected by those alone who have checked, also where it claims no work', () => {
	const belief = { writer: 'operator.place', at: 900, evidence: [], unconfirmed_since: null };
	const found = waysOf({ ...answerOf(SAYS, MOVE), if_checked: [offer({ id: 'life-4', title: 'said' })] }, { questions: [], variables: { b: estimate({ belief }) } });
	expect(found.offered.map(([, { id }]) => id)).toEqual([MOVE.id]);
	expect(found.checked.map(([, { id }]) => id)).toEqual([SAYS.id, 'life-4']);
	const doubted = { b: estimate({ belief: { ...belief, unconfirmed_since: 950 } }) };
	expect(waysOf(answerOf(SAYS), { questions: [], variables: doubted }).offered).toHaveLength(1);
});
