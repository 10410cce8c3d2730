import { afterEach, describe, expect, test, vi } from 'vitest';
import { acknowledge, refusalOf, setMode } from './send.ts';

afterEach(() => vi.unstubAllGlobals());

describe('a refusal', () => {
	test('carries the words of a problem document', () => {
		const body = '{"type":"/problems/task-gone","title":"Task gone","status":409,"detail":"Somebody else did it."}';
		expect(refusalOf(409, body)).toEqual({ title: 'Task gone', detail: 'Somebody else did it.', status: 409 });
	});

	test.each(['', '<html>', 'null', '3', '{"title":7}'])('has words even when the body is %j', (body) => {
		expect(refusalOf(502, body)).toEqual({
			title: 'Refused',
			detail: 'The server answered with status 502.',
			status: 502
		});
	});
});

describe('a command', () => {
	test('is sent as JSON, with the id of the task as one segment of the path', async () => {
		const fetch = vi.fn(() => Promise.resolve(new Response(null, { status: 204 })));
		vi.stubGlobal('fetch', fetch);
		expect(await acknowledge('a/b', 3)).toBeNull();
		expect(fetch).toHaveBeenCalledWith(
			'/api/v1/tasks/a%2Fb/acknowledgement',
			expect.objectContaining({
				method: 'POST',
				body: '{"revision":3}',
				headers: { 'Content-Type': 'application/json' }
			})
		);
	});

	test('that does not arrive says that it may have done nothing', async () => {
		vi.stubGlobal('fetch', () => Promise.reject(new TypeError('refused')));
		expect(await setMode('paused')).toMatchObject({ title: 'Not sent', status: null });
	});
});
