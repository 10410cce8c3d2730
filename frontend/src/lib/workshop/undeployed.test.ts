import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { undeployed } from './undeployed.svelte.ts';

const WAITS = { id: 'a', number: 12, name: 'Bolts', by: 'Eva', time: 0 };
const answers: object[] = [];
let asked = 0;

beforeEach(() => {
	vi.useFakeTimers();
	asked = 0;
	vi.stubGlobal('document', { visibilityState: 'visible', addEventListener: () => undefined, removeEventListener: () => undefined });
	vi.stubGlobal('fetch', () => {
		asked++;
		return Promise.resolve(new Response(JSON.stringify(answers.shift() ?? { number: 1, changes: 0, waits: null }), { headers: { 'content-type': 'application/json' } }));
	});
});

afterEach(() => {
	vi.useRealTimers();
	vi.unstubAllGlobals();
	answers.length = 0;
});

test('what waits for an approval is known within seconds where the station asks for one, and forgotten with who was signed in', async () => {
	answers.push({ number: 1, changes: 2, waits: null }, { number: 1, changes: 2, waits: WAITS });
	const stop = undeployed.follow(true);
	await vi.advanceTimersByTimeAsync(100);
	expect([undeployed.changes, undeployed.waits]).toEqual([2, null]);
	await vi.advanceTimersByTimeAsync(5000);
	expect(undeployed.waits).toEqual(WAITS);
	await vi.advanceTimersByTimeAsync(5000);
	expect(undeployed.waits).toBeNull();
	answers.push({ number: 1, changes: 2, waits: WAITS });
	undeployed.hear({ number: 2, changes: 2, comment: 1 });
	await vi.advanceTimersByTimeAsync(100);
	expect(undeployed.waits).toEqual(WAITS);
	stop();
	expect(undeployed.waits).toBeNull();
});

test('it is asked for again only where it may be otherwise, and seldom where nobody has to approve anything', async () => {
	const stop = undeployed.follow(false);
	await vi.advanceTimersByTimeAsync(100);
	undeployed.hear({ number: 3, changes: 2, comment: 1 });
	undeployed.hear({ number: 3, changes: 2, comment: 1 });
	await vi.advanceTimersByTimeAsync(20_000);
	expect(asked).toBe(2);
	stop();
	undeployed.hear({ number: 4, changes: 2, comment: 1 });
	await vi.advanceTimersByTimeAsync(60_000);
	expect(asked).toBe(2);
	expect(undeployed.changes).toBe(2);
});
