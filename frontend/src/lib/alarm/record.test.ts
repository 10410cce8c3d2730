import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Alarm, HistoryAnswer, RunRecord } from '#lib/contract.ts';
import { alarm } from '#lib/testing/view.ts';
import { arrivals, frequent, past, perSpan, reachesTo, turnsOf, withNewest, withOlder } from './record.ts';

function record(number: number, event = 'came', rest: Partial<Alarm> = {}, key = 'silent:robot'): RunRecord {
	const content = { alarm: key, event, ...alarm(rest) } as unknown as RunRecord['content'];
	return { number, time: number, kind: 'alarm', content, plan_message: null, hash: '' };
}

describe('of the turns in the life of an alarm', () => {
	test('those are its end with which nobody has to take note of it any more', () => {
		const turns = turnsOf([
			record(7, 'acknowledged', { ended: 6 }),
			record(6, 'returned', { ended: 6 }),
			record(5, 'came again'),
			record(4, 'ended', { ended: 4 }),
			record(3, 'acknowledged'),
			record(2, 'shelved', { ended: 2 })
		]);
		expect(past(turns).map((turn) => turn.number)).toEqual([7, 4]);
		expect(arrivals(turns, 5).map((turn) => turn.number)).toEqual([5]);
	});

	test('a record of another form is passed over', () => {
		expect(turnsOf([{ ...record(1), content: { what: 1 } }])).toEqual([]);
	});

	test('the most frequent come first, each as it was last', () => {
		const keys = ['a', 'b', 'a', 'c', 'a', 'b'];
		const turns = turnsOf(keys.map((key, place) => record(10 - place, 'came', { text: `${key} ${place}` }, key)));
		expect(frequent(turns, 2).map(([last, times]) => [last.alarm.text, times])).toEqual([
			['a 0', 3],
			['b 1', 2]
		]);
	});
});

test('each alarm is counted in the span in which it came, and none twice', () => {
	const times = fc.array(fc.integer({ min: 0, max: 99 }), { maxLength: 30 });
	fc.assert(
		fc.property(times, fc.integer({ min: 1, max: 12 }), fc.integer({ min: 1, max: 8 }), (came, seconds, n) => {
			const spans = perSpan(turnsOf(came.map((time) => record(time))), 100, seconds, n);
			expect(spans.map(({ at }) => at)).toEqual(spans.map((_, place) => 100 - (n - place) * seconds));
			for (const { at, count } of spans) expect(count).toBe(came.filter((time) => at <= time && time < at + seconds).length);
			expect(spans.reduce((sum, { count }) => sum + count, 0)).toBe(came.filter((time) => time >= 100 - n * seconds).length);
		})
	);
});

test('what is known is always a stretch of the journal without gaps, from the newest on', () => {
	const page = (length: number, before: number | null, size: number): HistoryAnswer => {
		const rest = Array.from({ length }, (_, place) => record(length - place)).filter(
			(each) => before === null || each.number < before
		);
		const records = rest.slice(0, size);
		return { records, next: rest.length > size ? (records.at(-1)?.number ?? null) : null };
	};
	const steps = fc.array(fc.oneof(fc.constant('older' as const), fc.nat(9)), { maxLength: 12 });
	fc.assert(
		fc.property(steps, fc.integer({ min: 1, max: 4 }), (acts, size) => {
			let length = 3;
			let known = withNewest(null, page(length, null, size));
			for (const act of acts) {
				if (act === 'older') {
					if (known.next !== null) known = withOlder(known, page(length, known.next, size));
					continue;
				}
				length += act;
				known = withNewest(known, page(length, null, size));
				const numbers = known.records.map((each) => each.number);
				expect(numbers).toEqual(numbers.map((_, place) => length - place));
				expect(known.next === null).toBe(numbers.length === length);
				expect(reachesTo(known, 1)).toBe(numbers.length === length);
			}
		})
	);
});
