import { afterEach, describe, expect, test, vi } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { acknowledge, reportProblem, solveProblem } from '#lib/task/send.ts';
import { acknowledgeAlarm, decideOutputs, putBack, setMode, takeControl, takeOut } from './send.ts';

afterEach(() => vi.unstubAllGlobals());

function accepting(): ReturnType<typeof vi.fn> {
	const fetch = vi.fn(() => Promise.resolve(new Response(null, { status: 204 })));
	vi.stubGlobal('fetch', fetch);
	return fetch;
}

describe('a command', () => {
	test('is sent as JSON, with the id of the task as one segment of the path', async () => {
		const fetch = accepting();
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

test('control is taken from the session that was shown, with a reason only where one was given', async () => {
	const fetch = accepting();
	await takeControl(null, ' ');
	await takeControl('s-1', ' end of shift ');
	expect(fetch.mock.calls.map(([, { body }]) => body)).toEqual([
		'{"over":null}',
		'{"over":"s-1","reason":"end of shift"}'
	]);
});

test('what an act is about stands in its address or body, names of the model as one segment', async () => {
	const fetch = accepting();
	await putBack({ of: 'ability', name: 'robot.move(a/b)' }, 'oiled');
	await takeOut('resource', 'robot', 'leaks');
	await acknowledgeAlarm('silent /ur10/state', alarm({ since: 12.5 }));
	await reportProblem('a/b', 3, 'missing', ' no bolts ');
	await reportProblem('a/b', 3, null, ' ');
	await solveProblem('a/b', 3);
	await decideOutputs({ 'robot.go': false }, 'looked');
	expect(fetch.mock.calls.map(([path, { method, body }]) => [method, path, body])).toEqual([
		['PUT', '/api/v1/availability/ability/robot.move(a%2Fb)', '{"in_service":true,"reason":"oiled"}'],
		['PUT', '/api/v1/availability/resource/robot', '{"in_service":false,"reason":"leaks"}'],
		['POST', '/api/v1/alarms/acknowledge', '{"alarm":"silent /ur10/state","since":12.5}'],
		['POST', '/api/v1/tasks/a%2Fb/problem', '{"revision":3,"what":"missing","reason":"no bolts"}'],
		['POST', '/api/v1/tasks/a%2Fb/problem', '{"revision":3,"what":null}'],
		['POST', '/api/v1/tasks/a%2Fb/problem/solved', '{"revision":3}'],
		['PUT', '/api/v1/restored-outputs', '{"values":{"robot.go":false},"reason":"looked"}']
	]);
});
