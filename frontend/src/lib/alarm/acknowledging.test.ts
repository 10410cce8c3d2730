import { expect, test } from 'vitest';
import type { Refusal } from '#lib/rest/refusal.ts';
import { alarm } from '#lib/testing/view.ts';
import { acknowledgeEach, standsAs } from './acknowledging.ts';
import type { Keyed } from './priority.ts';

const refusal = (kind: string | null, status: number | null): Refusal => ({
	title: 'No',
	detail: '',
	status,
	kind,
	retryAfter: null,
	place: null
});
const SHOWN: Keyed[] = ['a', 'b', 'c'].map((key, place) => [key, alarm({ since: place })]);

/** Acknowledges all that were shown, where the server answers so. */
async function sent(answers: Record<string, Refusal>): Promise<{ tried: string[]; left: string[] }> {
	const tried: string[] = [];
	const left = await acknowledgeEach(SHOWN, (key, { since }) => {
		tried.push(`${key} ${since}`);
		return Promise.resolve(answers[key] ?? null);
	});
	return { tried, left: left.map((each) => each.key) };
}

test('each alarm is acknowledged as it was shown', async () => {
	expect(await sent({})).toEqual({ tried: ['a 0', 'b 1', 'c 2'], left: [] });
});

test('one that came again stays, one that is gone needs nothing, and the others are acknowledged', async () => {
	const answers = { a: refusal('alarm-recurred', 409), b: refusal('alarm-gone', 409) };
	expect(await sent(answers)).toEqual({ tried: ['a 0', 'b 1', 'c 2'], left: ['a'] });
});

test('where the server is not reached, the rest is not tried', async () => {
	expect(await sent({ b: refusal(null, null) })).toEqual({ tried: ['a 0', 'b 1'], left: ['b'] });
});

test('what was shown is compared with what there is', () => {
	const shown: Keyed = ['a', alarm({ since: 5 })];
	expect(standsAs(shown, { a: alarm({ since: 5, state: 'returned' }) })).toBe('same');
	expect(standsAs(shown, { a: alarm({ since: 7 }) })).toBe('moved');
	expect(standsAs(shown, { a: alarm({ since: 5, state: 'acknowledged' }) })).toBe('gone');
	expect(standsAs(shown, {})).toBe('gone');
});
