import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { AuditAnswer, AuditRecord, Outcome } from '#lib/contract.ts';
import { actsOf, outcomeOf, withNewest, withOlder } from './acts.ts';

function record(number: number, outcome: Outcome = 'done', about: number | null = null): AuditRecord {
	const actor = { kind: 'person', id: 'p1', name: 'Eva' } as const;
	return { number, time: number, hash: '', entry: { actor, action: 'set-mode', subject: '', outcome, about } };
}

/** The records of a journal of `length`, of which some tell the end of one before them. */
const journals = fc.array(fc.option(fc.nat(5)), { maxLength: 60 }).map((backs) =>
	backs.map((back, n) => record(n + 1, 'done', back === null || n - back < 1 ? null : n - back)).reverse()
);

/** A page of `size` records of `all` (newest first) that come before the number `before`. */
function page(all: readonly AuditRecord[], before: number | null, size: number): AuditAnswer {
	const rest = all.filter((each) => before === null || each.number < before);
	const records = rest.slice(0, size);
	return { records, next: rest.length > size ? (records.at(-1)?.number ?? null) : null };
}

describe('acts', () => {
	test('show a command and its end as one', () => {
		const acts = actsOf([record(4, 'refused', 2), record(3, 'done', 1), record(2, 'requested'), record(1, 'requested')]);
		expect(acts.map((act) => [act.record.number, outcomeOf(act)])).toEqual([
			[2, 'refused'],
			[1, 'done']
		]);
	});

	test('say that the end is not known where none is written', () => {
		expect(actsOf([record(1, 'requested')]).map(outcomeOf)).toEqual(['requested']);
	});

	test('show every record once', () => {
		fc.assert(
			fc.property(journals, fc.nat(60), (all, from) => {
				const records = all.slice(from);
				const shown = actsOf(records).flatMap((act) => [act.record, ...(act.end ? [act.end] : [])]);
				expect(shown.map((each) => each.number).sort((a, b) => b - a)).toEqual(records.map((each) => each.number));
			})
		);
	});
});

test('what is known is always a stretch of the journal without gaps, from the newest on', () => {
	const steps = fc.array(fc.oneof(fc.constant('older' as const), fc.nat(12)), { maxLength: 12 });
	fc.assert(
		fc.property(steps, fc.integer({ min: 1, max: 5 }), (acts, size) => {
			let all: AuditRecord[] = [record(1)];
			let known = withNewest(null, page(all, null, size));
			for (const act of acts) {
				if (act === 'older') {
					if (known.next !== null) known = withOlder(known, page(all, known.next, size));
					continue;
				}
				for (let n = 0; n < act; n++) all = [record(all.length + 1), ...all];
				known = withNewest(known, page(all, null, size));
				const kept = known.records.map((each) => each.number);
				expect(kept).toEqual(all.slice(0, kept.length).map((each) => each.number));
				expect(known.next === null).toBe(kept.length === all.length);
			}
		})
	);
});
