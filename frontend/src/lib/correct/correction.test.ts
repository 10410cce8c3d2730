import { afterEach, describe, expect, test, vi } from 'vitest';
import type { CorrectionPreview, StationView } from '#lib/contract.ts';
import type { Station } from '#lib/stream/station.svelte.ts';
import { estimate, view } from '#lib/testing/view.ts';
import { Correction } from './correction.svelte.ts';
import { changesSince } from './moved.ts';

afterEach(() => vi.unstubAllGlobals());

const bolts = { b: estimate({ value: 'placed' }), c: estimate({ value: 'empty' }) };
const preview = (revision: number): Partial<CorrectionPreview> => ({ revision });

/** A station that a test moves on. */
function standing(over: Partial<StationView> = {}): { station: Station; move: (over: Partial<StationView>) => void } {
	const station = { view: view({ revision: 4, variables: bolts, ...over }) };
	return {
		station: station as unknown as Station,
		move: (next) => (station.view = { ...station.view, ...next })
	};
}

/** Lets the server answer one request after the other. */
function answers(...all: [status: number, body: object | null][]): ReturnType<typeof vi.fn> {
	const waiting = [...all];
	const fetch = vi.fn(() => {
		const [status, body] = waiting.shift() ?? [500, null];
		return Promise.resolve(new Response(body && JSON.stringify(body), { status }));
	});
	vi.stubGlobal('fetch', fetch);
	return fetch;
}

const sent = (fetch: ReturnType<typeof vi.fn>, call: number): unknown =>
	JSON.parse((fetch.mock.calls[call]?.[1] as { body: string }).body);

describe('a correction', () => {
	test('is made on the revision that was looked at, with what differs alone', async () => {
		const { station } = standing();
		const fetch = answers([200, preview(4)], [204, null]);
		const correction = new Correction(station, ['b', 'c']);
		correction.choose('b', 'empty');
		correction.choose('c', 'empty');
		await correction.look();
		correction.reason = ' seen ';
		expect(await correction.make()).toBe(true);
		expect(sent(fetch, 0)).toEqual({ values: { b: 'empty' } });
		expect(sent(fetch, 1)).toEqual({ values: { b: 'empty' }, revision: 4, reason: 'seen' });
	});

	test('is not made before it was looked at, nor when something else was chosen since', async () => {
		const { station } = standing();
		const fetch = answers([200, preview(4)]);
		const correction = new Correction(station, ['b', 'c']);
		expect(await correction.make()).toBe(false);
		correction.choose('b', 'empty');
		await correction.look();
		correction.choose('c', 'placed');
		expect(correction.preview).toBeNull();
		expect(await correction.make()).toBe(false);
		expect(fetch).toHaveBeenCalledTimes(1);
	});

	test('that is refused as the state moved keeps what was chosen, and has to be looked at again', async () => {
		const { station } = standing();
		answers([200, preview(4)], [409, { type: '/problems/stale-revision' }], [200, preview(5)], [204, null]);
		const correction = new Correction(station, ['b']);
		correction.choose('b', 'empty');
		correction.reason = 'seen';
		await correction.look();
		correction.asked = true;
		expect(await correction.make()).toBe(false);
		expect(correction).toMatchObject({ moved: true, asked: false, reason: 'seen', values: { b: 'empty' } });
		expect(await correction.make()).toBe(false);
		await correction.look();
		expect(correction.moved).toBe(false);
		expect(await correction.make()).toBe(true);
	});

	test('takes control and enters restart mode by the same press, and is made only if the same follows then', async () => {
		const { station, move } = standing({ mode: 'automatic' });
		const safe = { ...preview(4), safe: true, safe_now: true, violates: [] };
		const unsafe = { ...preview(6), safe: false, safe_now: true, violates: [{ name: 's', title: 'S' }] };
		const fetch = answers(
			[200, safe],
			[204, null],
			[204, null],
			[200, unsafe],
			[200, { ...unsafe, revision: 6 }],
			[204, null]
		);
		const correction = new Correction(station, ['b']);
		correction.choose('b', 'empty');
		correction.reason = 'seen';
		await correction.look();
		const making = correction.make({ control: true, restart: true });
		move({ mode: 'restart', revision: 6 });
		expect(await making).toBe(false);
		expect(correction).toMatchObject({ altered: true, moved: false, refusal: null, asksTwice: true, values: { b: 'empty' } });
		expect(fetch.mock.calls.map(([path]) => String(path))).toEqual([
			'/api/v1/corrections/preview',
			'/api/v1/control-lock',
			'/api/v1/restart/enter',
			'/api/v1/corrections/preview'
		]);
		await correction.look();
		expect(await correction.make()).toBe(true);
		expect(sent(fetch, 5)).toEqual({ values: { b: 'empty' }, revision: 6, reason: 'seen' });
	});

	test('is not made where control or restart mode is refused', async () => {
		const { station } = standing({ mode: 'automatic' });
		const fetch = answers([200, preview(4)], [409, { type: '/problems/control-held' }]);
		const correction = new Correction(station, ['b']);
		correction.choose('b', 'empty');
		await correction.look();
		expect(await correction.make({ control: true, restart: true })).toBe(false);
		expect(correction.refusal?.kind).toBe('control-held');
		expect(fetch).toHaveBeenCalledTimes(2);
	});

	test('takes the last one back by its revision', async () => {
		const { station } = standing();
		const fetch = answers([200, preview(4)], [204, null]);
		const last = { revision: 3, values: { b: 'placed' }, before: { b: 'empty' }, by: 'Eva', why: '', at: 0, undoable: true };
		const correction = new Correction(station, ['b'], last);
		await correction.look();
		correction.reason = 'wrong pair';
		expect(await correction.make()).toBe(true);
		expect(sent(fetch, 0)).toEqual({ values: { b: 'empty' } });
		expect(sent(fetch, 1)).toEqual({ revision: 3, reason: 'wrong pair' });
	});
});

test('what has changed since is told by its values', () => {
	const now = { ...bolts, c: { ...bolts.c, since: 990 }, b: { ...bolts.b, value: 'empty' } };
	expect(changesSince(bolts, now)).toEqual([{ name: 'b', before: 'placed', now: 'empty' }]);
});
