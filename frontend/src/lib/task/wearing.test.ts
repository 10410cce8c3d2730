import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { WatchSelf } from '#lib/contract.ts';
import type { Answer } from '#lib/rest/request.ts';
import { after, digitsOf, grouped, wearingOf, type Wearing } from './wearing.ts';

const SELF: WatchSelf = { id: 'w1', name: 'Left wrist', resource: 'operator', state: 'waiting' };
const WAITING: Wearing = { kind: 'waiting', self: SELF };
const ACTIVE: Wearing = { kind: 'active', self: { ...SELF, state: 'active' } };

function refused(status: number | null): Answer<WatchSelf> {
	return { ok: false, refusal: { title: '', detail: '', status, kind: null, retryAfter: null, place: null } };
}

describe('a device', () => {
	test('that waits becomes a watch once it is confirmed', () => {
		const answer: Answer<WatchSelf> = { ok: true, value: { ...SELF, state: 'active' }, etag: null, ahead: 0 };
		expect(after(WAITING, answer)).toEqual(ACTIVE);
	});

	test('that is a watch no longer says why, and may be paired again', () => {
		expect(after(WAITING, refused(401))).toMatchObject({ kind: 'none', lost: { title: 'Not confirmed' } });
		expect(after(ACTIVE, refused(401))).toMatchObject({ kind: 'none', lost: { title: 'Revoked or expired' } });
		expect(wearingOf(null, 'Left wrist')).toMatchObject({
			kind: 'none',
			lost: { detail: expect.stringContaining('Left wrist') }
		});
		expect(wearingOf(null, null)).toEqual({ kind: 'none', lost: null });
	});

	test.each([null, 403, 429, 500, 503])('stays what it is when the server answers %j', (status) => {
		for (const wearing of [WAITING, ACTIVE]) expect(after(wearing, refused(status))).toBe(wearing);
	});
});

describe('a code', () => {
	test('is understood however it is typed', () => {
		expect(['48210937', '4821 0937', ' 4821-0937 ', '482109371'].map(digitsOf)).toEqual(Array(4).fill('48210937'));
		fc.assert(
			fc.property(fc.string(), (typed) => {
				expect(digitsOf(typed)).toMatch(/^\d{0,8}$/);
			})
		);
	});

	test('is shown in two groups and is the same code', () => {
		expect(grouped('48210937')).toBe('4821 0937');
		fc.assert(
			fc.property(fc.stringMatching(/^\d{0,8}$/), (digits) => {
				expect(digitsOf(grouped(digits))).toBe(digits);
			})
		);
	});
});
