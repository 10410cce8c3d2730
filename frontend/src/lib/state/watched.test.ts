import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { keepWatched, keptWatched } from './watched.ts';

let stored: Map<string, string>;
beforeEach(() => {
	stored = new Map();
	vi.stubGlobal('localStorage', {
		getItem: (key: string) => stored.get(key) ?? null,
		setItem: (key: string, text: string) => void stored.set(key, text),
		removeItem: (key: string) => void stored.delete(key)
	});
});
afterEach(() => vi.unstubAllGlobals());

test('what is watched is known again, names with commas and brackets too', () => {
	const names = ['bolts[bolt_pair_1]', 'robot.pose', 'odd, name'];
	keepWatched(names);
	expect(keptWatched()).toEqual(names);
	keepWatched([]);
	expect(stored.size).toBe(0);
});

test('what somebody else has kept there counts for nothing, and no browser has to keep anything', () => {
	for (const text of ['{', '{"a": 1}', '[1, null]']) {
		stored.set('state-watched', text);
		expect(keptWatched()).toEqual([]);
	}
	vi.stubGlobal('localStorage', undefined);
	keepWatched(['robot.pose']);
	expect(keptWatched()).toEqual([]);
});
