import fc from 'fast-check';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { choose } from '#lib/text/text.svelte.ts';
import { refusalOf } from './refusal.ts';

describe('a refusal', () => {
	test('carries the words and the kind of a problem document', () => {
		const body = '{"type":"/problems/task-gone","title":"Task gone","status":409,"detail":"Somebody else did it."}';
		expect(refusalOf(409, body)).toEqual({
			title: 'Task gone',
			detail: 'Somebody else did it.',
			status: 409,
			kind: 'task-gone',
			retryAfter: null,
			place: null
		});
	});

	describe('to who reads Swedish', () => {
		beforeEach(() => vi.stubGlobal('document', { documentElement: {} }));
		afterEach(async () => {
			await choose('en');
			vi.unstubAllGlobals();
		});

		test('is told in Swedish where it is a kind of text, and as it was written where it is not', async () => {
			await choose('sv');
			const of = (detail: string, detail_message?: object) =>
				refusalOf(403, JSON.stringify({ title: 'Wrong password', title_message: { id: 'refused.wrong-password' }, detail, detail_message }));
			expect(of('The old one.', { id: 'refused.too-many-attempts.seconds', arguments: { seconds: 3 } })).toMatchObject({
				title: 'Fel lösenord',
				detail: 'Det har varit för många felaktiga försök. Försök igen om 3 s.'
			});
			expect(of('The old one.', { id: 'of-another-version' }).detail).toBe('The old one.');
			expect(of('The old one.').detail).toBe('The old one.');
		});
	});

	test.each(['', '<html>', 'null', '3', '{"title":7,"type":[]}', '{"type":"about:blank"}'])(
		'has words even when the body is %j',
		(body) => {
			expect(refusalOf(502, body)).toEqual({
				title: 'Refused',
				detail: 'The server answered with status 502.',
				status: 502,
				kind: null,
				retryAfter: null,
				place: null
			});
		}
	);

	test('says in whole seconds when to try again, if the server says so', () => {
		const seconds = ['40', '0.2', '1e9', '', 'soon', '-3', '0'].map((header) => refusalOf(429, '', header).retryAfter);
		expect(seconds).toEqual([40, 1, 86400, null, null, null, null]);
		fc.assert(
			fc.property(fc.string(), (header) => {
				const { retryAfter } = refusalOf(429, '', header);
				expect(retryAfter === null || (retryAfter >= 1 && retryAfter <= 86400)).toBe(true);
			})
		);
	});
});
