import { expect, test } from 'vitest';
import { offer, preview } from '#lib/testing/offer.ts';
import { operation, view } from '#lib/testing/view.ts';
import { en } from '#lib/text/en.ts';
import { asksForHands, canBeTaken, goesOn, goesOnMeanwhile, isSoAlready, mayBeWanted, onlySays } from './offer.ts';
import { assured, handsOf, kindWord, resourcesOf, stillAsked, storyOf, tasksOf, timesOf, timeWords, titleOf } from './offer-words.ts';

const CHANGE = { name: 'b', now: 'placed', then: 'empty', so: { id: 'as-it-was', arguments: { text: 'b is empty' } }, by_hand: null };

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
	expect([8.2, 8.85 - 6.85 + 1, 59.2, 80, 119.5, 660].map(said)).toEqual(['≈ 9 s', '≈ 3 s', '≈ 1 min', '≈ 1 min 20 s', '≈ 2 min', '≈ 11 min']);
});

test('what a way takes by itself is told from what the station does then', () => {
	const effort = { ...offer().effort, seconds: 18, time: 20 };
	const errand = preview('move', 'turn');
	// Two seconds are people's.
	expect(timesOf(offer({ errand, effort }))).toEqual({ own: 4, all: 20 });
	expect(timesOf(offer({ errand, effort, then: null }))).toEqual({ own: 20, all: 20 });
	expect(timesOf(offer({ errand, effort, then: preview() }))).toEqual({ own: 20, all: 20 });
	expect(timesOf(offer({ effort }))).toEqual({ own: 20, all: 20 });
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

test('whoever is to go in holds the station first, where it would go on by itself', () => {
	const hands = offer({ physical: [CHANGE] });
	const works = { mode: 'automatic', production: 'started' } as const;
	expect(goesOnMeanwhile(hands, works)).toBe(true);
	expect(goesOnMeanwhile(hands, { ...works, mode: 'hold' })).toBe(false);
	expect(goesOnMeanwhile(hands, { ...works, mode: 'restart' })).toBe(false);
	expect(goesOnMeanwhile(hands, { ...works, production: 'waiting' })).toBe(false);
	expect(goesOnMeanwhile(offer({ online: ['robot'] }), works)).toBe(true);
});

test('who says too early that it is done hears what is not so yet', () => {
	const silent = view({ resources: { robot: { title: 'Robot UR10', online: false, awaited_topics: ['/state'] } } });
	expect(stillAsked(silent, offer({ online: ['robot'] }))).toBe('Checked: Robot UR10 is still not heard.');
	expect(stillAsked(silent, offer({ physical: [CHANGE] }))).toBe('Checked: it is not so yet that b is empty (now: placed).');
	expect(stillAsked(silent, offer({ in_service: ['move'], online: ['robot'] }))).toMatch(/^Checked: Robot UR10 is still not heard, .* is still out of service\.$/);
	const heard = view({ resources: { robot: { title: 'Robot UR10', online: true, awaited_topics: [] } } });
	expect(stillAsked(heard, offer({ online: ['robot'] }))).toBe(null);
});

test('what somebody says to be done is not among what the station then does', () => {
	const operations = { tighten: operation({ title: 'Tighten' }), place: operation({ title: 'Place' }) };
	const story = (claims: string[]): string => storyOf(view({ operations }), offer({ corrections: [CHANGE], goals: ['tighten', 'place'], claims }));
	expect(story([])).toBe('Then the station goes on: Tighten, Place.');
	expect(story(['tighten'])).toBe('Then the station goes on: Place.');
	expect(story(['tighten', 'place'])).toBe('Then the station goes on.');
});

test('a task that a person does before something is corrected is told as one, and not as done already', () => {
	const how = { id: 'as-it-was', arguments: { text: 'Put in two bolts.' } };
	const title = { title: 'Do it yourself: Place the bolts', title_message: { id: 'as-it-was', arguments: { text: 'Do it yourself: Place the bolts' } } };
	const task = offer({ ...title, corrections: [{ ...CHANGE, by_hand: how }], only_if_checked: true, claims: ['place'] });
	expect(tasksOf(task)).toEqual(['Put in two bolts.']);
	expect(handsOf(task)).toBe(1);
	expect(titleOf(task)).toBe('Do it yourself: Place the bolts');
	const said = { ...task, corrections: [CHANGE] };
	expect([tasksOf(said), handsOf(said), titleOf(said)]).toEqual([[], 0, 'Already so: b is empty']);
});

test('before something moves a person makes sure that nobody reaches in, and hears what moves first', () => {
	const { steps, ...rest } = preview('place', 'move');
	const errand = { ...rest, steps: steps.map((step) => ({ ...step, human: step.ability === 'place' })) };
	const known = view({ resources: {} });
	expect(assured(known, offer({ errand }))).toBe('Nobody reaches in: robot moves first (move). All 2 starts may be carried out.');
	expect(assured(known, offer({ errand: preview('move') }))).toBe('Nobody reaches in: robot moves first (move). This start may be carried out.');
	const quiet = preview('lamp');
	expect(assured(known, offer({ errand: { ...quiet, steps: quiet.steps.map((step) => ({ ...step, moves: false })) } }))).toBe('This start may be carried out.');
	expect(assured(known, offer({ errand: { ...preview(), ticks: 3 } }))).toBe('I will wait for it.');
});

test('what is so already is neither started nor waited for', () => {
	const reset = offer({ kind: 'reset', operation: 'tighten', errand: preview() });
	expect(isSoAlready(reset)).toBe(true);
	expect(storyOf(view({}), reset)).toContain('It is so already');
	expect(isSoAlready(offer({ errand: { ...preview(), ticks: 3 } }))).toBe(false);
	expect(isSoAlready(offer())).toBe(false);
});
