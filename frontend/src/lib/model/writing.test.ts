import { beforeEach, describe, expect, test, vi } from 'vitest';
import type { Refusal } from '#lib/rest/refusal.ts';
import { Writing } from './writing.svelte.ts';

const CHANGED: Refusal = { title: 'Changed', detail: '', status: 409, kind: 'part-changed', retryAfter: null, place: null };
const AWAY: Refusal = { title: 'Away', detail: '', status: null, kind: null, retryAfter: null, place: null };

describe('what is typed in a field', () => {
	let draft: string;
	let refusal: Refusal | null;
	let sent: [string, string][];
	let writing: Writing<string>;

	beforeEach(() => {
		vi.useFakeTimers();
		draft = 'old';
		refusal = null;
		sent = [];
		writing = new Writing<string>('a field', {
			read: () => draft,
			equal: (one, other) => one === other,
			normal: (mine) => mine.trim(),
			send: (was, mine) => {
				sent.push([was, mine]);
				if (refusal === null) draft = mine.trim();
				return Promise.resolve(refusal);
			}
		});
	});

	test('is sent after a pause, once, with what it was made from', async () => {
		writing.type('n');
		writing.type('ne');
		await vi.advanceTimersByTimeAsync(300);
		writing.type('new');
		expect(sent).toEqual([]);
		await vi.advanceTimersByTimeAsync(1000);
		expect(sent).toEqual([['old', 'new']]);
		expect([writing.dirty, writing.accepted, writing.shown]).toEqual([false, true, 'new']);
	});

	test('stays as it was typed while the person is there, and follows others after that', async () => {
		writing.type('new ');
		await vi.advanceTimersByTimeAsync(1000);
		expect(writing.shown).toBe('new ');
		draft = 'of another';
		expect(writing.shown).toBe('of another');
		draft = 'new';
		await writing.leave();
		expect(writing.shown).toBe('new');
	});

	test('is kept beside what somebody else has written, until one is chosen', async () => {
		writing.type('mine');
		draft = 'theirs';
		refusal = CHANGED;
		await writing.flush();
		expect([writing.conflict, writing.shown, writing.theirs]).toEqual([true, 'mine', 'theirs']);
		writing.type('mine too');
		await vi.advanceTimersByTimeAsync(5000);
		expect(sent).toHaveLength(1);
		refusal = null;
		await writing.insist();
		expect(sent.at(-1)).toEqual(['theirs', 'mine too']);
		expect([writing.conflict, draft]).toEqual([false, 'mine too']);
	});

	test('is let go where theirs is taken', async () => {
		writing.type('mine');
		draft = 'theirs';
		refusal = CHANGED;
		await writing.flush();
		writing.drop();
		expect([writing.conflict, writing.dirty, writing.shown]).toEqual([false, false, 'theirs']);
	});

	test('is kept where it could not be sent, and sent again on demand', async () => {
		refusal = AWAY;
		writing.type('mine');
		await writing.flush();
		expect([writing.dirty, writing.refusal, writing.shown]).toEqual([true, AWAY, 'mine']);
		refusal = null;
		await writing.flush();
		expect([writing.dirty, draft]).toEqual([false, 'mine']);
	});
});
