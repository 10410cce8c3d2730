import { expect, test } from 'vitest';
import { alarm, estimate, view } from '#lib/testing/view.ts';
import { answeredQuestions, askedNow, openQuestions } from './answers.ts';

const question = { variable: 'b', believed: 'placed', so: { id: 'as-it-was', arguments: { text: 'so' } }, possible: ['empty'], because: [], because_messages: [] };

function asked(at: number): ReturnType<typeof view> {
	const belief = { writer: 'Eva', at, evidence: [], unconfirmed_since: null };
	return view({
		questions: [question],
		alarms: { contradiction: alarm({ since: 950 }) },
		variables: { b: estimate({ belief }) }
	});
}

test('a question is open until somebody has said something since it came up', () => {
	expect([openQuestions(asked(900)).length, answeredQuestions(asked(900)).length]).toEqual([1, 0]);
	expect([openQuestions(asked(960)).length, answeredQuestions(asked(960)).length]).toEqual([0, 1]);
	expect(openQuestions(view({ questions: [question] }))).toEqual([question]);
});

test('what is wrong in any case is asked about by itself, and what may all be so together', () => {
	const wrong = { ...question, variable: 'w' };
	const maybe = ['a', 'c'].map((variable) => ({ ...question, variable, possible: ['empty', 'placed'] }));
	expect(askedNow([wrong, ...maybe])).toEqual([wrong]);
	expect(askedNow(maybe)).toEqual(maybe);
	expect(askedNow([...maybe, wrong])).toEqual(maybe);
	expect(askedNow([])).toEqual([]);
});
