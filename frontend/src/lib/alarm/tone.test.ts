import { expect, test } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { isNews, urgent } from './tone.ts';

const high = (since: number) => alarm({ priority: 'high', since });

test('a tone is for an alarm of high priority that comes, comes again, or becomes one', () => {
	const before = urgent({ a: high(1), b: alarm() });
	expect(isNews(before, urgent({ a: high(1), b: alarm() }))).toBe(false);
	expect(isNews(before, urgent({ a: high(2), b: alarm() }))).toBe(true);
	expect(isNews(before, urgent({ a: high(1), b: alarm({ priority: 'high' }) }))).toBe(true);
	expect(isNews(before, urgent({ a: high(1), c: alarm({ priority: 'medium' }) }))).toBe(false);
	expect(isNews(before, urgent({ a: alarm({ priority: 'high', since: 3, state: 'acknowledged' }) }))).toBe(false);
});

test('what was there when the page was opened is not new', () => {
	expect(isNews(null, urgent({ a: high(1) }))).toBe(false);
});
