import { afterEach, describe, expect, test, vi } from 'vitest';
import { aheadOf, command, request, whenSignedOut } from './request.ts';

afterEach(() => vi.unstubAllGlobals());

/** Lets the server answer so. */
function answers(body: string | null, init: ResponseInit): ReturnType<typeof vi.fn> {
	const fetch = vi.fn(() => Promise.resolve(new Response(body, init)));
	vi.stubGlobal('fetch', fetch);
	return fetch;
}

test('how far the clock of the server is ahead is known to a second', () => {
	const now = Date.parse('Sun, 22 Nov 2026 03:00:00 GMT');
	expect(aheadOf('Sun, 22 Nov 2026 03:10:00 GMT', now)).toBe(600);
	expect(aheadOf('Sun, 22 Nov 2026 02:59:59 GMT', now + 900)).toBe(-1.9);
	expect(aheadOf('Sun, 22 Nov 2026 03:00:00 GMT', now + 900)).toBe(0);
	expect(aheadOf(null, now)).toBe(0);
	expect(aheadOf('soon', now)).toBe(0);
});

describe('a request', () => {
	test('sends what it has as JSON, upon the revision that was seen', async () => {
		const fetch = answers('{"id":"a"}', { headers: { ETag: '"3"' } });
		expect(await request('PATCH', '/api/v1/station', { body: { role: 'viewer' }, ifMatch: '"2"' })).toEqual({
			ok: true,
			value: { id: 'a' },
			etag: '"3"',
			ahead: 0
		});
		expect(fetch).toHaveBeenCalledWith(
			'/api/v1/station',
			expect.objectContaining({
				method: 'PATCH',
				body: '{"role":"viewer"}',
				headers: { 'Content-Type': 'application/json', 'If-Match': '"2"' }
			})
		);
	});

	test('that is answered without content has no value', async () => {
		answers(null, { status: 204 });
		expect(await request('DELETE', '/api/v1/station')).toMatchObject({ ok: true, value: undefined });
	});

	test('that finds nobody signed in tells those who listen; a wrong password does not', async () => {
		const told = vi.fn();
		const stop = whenSignedOut(told);
		answers('{"type":"/problems/wrong-name-or-password"}', { status: 401 });
		await request('POST', '/api/v1/station');
		expect(told).not.toHaveBeenCalled();
		answers('{"type":"/problems/signed-out"}', { status: 401 });
		await request('GET', '/api/v1/station');
		expect(told).toHaveBeenCalledTimes(1);
		stop();
		answers('{"type":"/problems/signed-out"}', { status: 401 });
		await request('GET', '/api/v1/station');
		expect(told).toHaveBeenCalledTimes(1);
	});

	test('that gets no answer may have acted; one that only reads has changed nothing', async () => {
		vi.stubGlobal('fetch', () => Promise.reject(new TypeError('refused')));
		expect(await command('DELETE', '/api/v1/station')).toMatchObject({ title: 'Not sent', status: null, kind: null });
		expect(await request('GET', '/api/v1/station')).toMatchObject({ ok: false, refusal: { title: 'Not read', status: null } });
		vi.stubGlobal('fetch', () => Promise.reject(new DOMException('late', 'TimeoutError')));
		expect(await command('DELETE', '/api/v1/station')).toMatchObject({ title: 'No answer', status: null, kind: 'no-answer' });
	});
});
