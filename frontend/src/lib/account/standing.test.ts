import { expect, test } from 'vitest';
import { sessionAnswer } from '#lib/testing/session.ts';
import { ASKING, after, type Standing } from './standing.ts';

const KNOWN: Standing = { state: 'known', answer: sessionAnswer() };
const UNREACHED = { kind: 'unanswered', why: 'The server cannot be reached.' } as const;

test('what the server says holds, whatever was known', () => {
	const out = sessionAnswer({ state: 'signed-out' });
	for (const before of [ASKING, KNOWN])
		expect(after(before, { kind: 'answered', answer: out })).toEqual({ state: 'known', answer: out });
});

test('a server that is not reached ends no session; before it has answered it is said why nothing is shown', () => {
	expect(after(KNOWN, UNREACHED)).toBe(KNOWN);
	expect(after(ASKING, UNREACHED)).toEqual({ state: 'asking', trouble: UNREACHED.why });
});

test('a session in doubt shows nothing until the server has answered', () => {
	const doubted = after(KNOWN, { kind: 'doubted' });
	expect(doubted).toEqual(ASKING);
	expect(after(doubted, UNREACHED)).toMatchObject({ state: 'asking' });
	const troubled = after(ASKING, UNREACHED);
	expect(after(troubled, { kind: 'doubted' })).toBe(troubled);
});
