import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { AuditRecord, RunRecord } from '#lib/contract.ts';
import { boundOf, joined, meets, readOf, rowsOf } from './rows.ts';
import { changedAt, sortedBy } from './state.ts';
import { EVERYTHING_OF_NOTE, isAct, questionOf } from './sought.ts';

function record(number: number, time: number): RunRecord {
	return { number, time, kind: 'ticked', content: {}, plan_message: null, hash: '' };
}

function act(number: number, time: number, about: number | null = null): AuditRecord {
	const actor = { kind: 'person', id: 'p1', name: 'Eva' } as const;
	return { number, time, hash: '', entry: { actor, action: 'set-mode', subject: 'robot.pose', outcome: 'done', about } };
}

test('a command and its end are one row, before what it brought about', () => {
	const rows = rowsOf([record(2, 20), record(1, 10)], [act(8, 20.5, 7), act(7, 20)]);
	expect(rows.map((row) => row.key)).toEqual(['r2', 'a7', 'r1']);
	expect(rows[1]?.act?.end?.number).toBe(8);
});

test('what was read twice is there once, the newest first', () => {
	fc.assert(
		fc.property(fc.uniqueArray(fc.nat(50)), fc.uniqueArray(fc.nat(50)), (one, other) => {
			const found = joined(one.map((n) => record(n, n)), other.map((n) => record(n, n))).map((each) => each.number);
			expect(found).toEqual([...new Set([...one, ...other])].sort((a, b) => b - a));
		})
	);
});

test('what is sought is asked of the server, and of acts it is found here', () => {
	const query = questionOf({ ...EVERYTHING_OF_NOTE, resource: 'robot', text: 'at home', who: { id: 'p1', name: 'Eva' } }, null);
	expect(query?.getAll('name')).toEqual(['robot.']);
	expect(query?.getAll('text')).toEqual(['at home', 'at_home']);
	expect(query?.get('who')).toBe('Eva');
	expect(questionOf({ ...EVERYTHING_OF_NOTE, kind: 'people' }, null)).toBeNull();
	expect(isAct(act(1, 1), { ...EVERYTHING_OF_NOTE, resource: 'robot', text: 'POSE' }, null)).toBe(true);
	expect(isAct(act(1, 1), { ...EVERYTHING_OF_NOTE, who: { id: 'p2', name: 'Adam' } }, null)).toBe(false);
	expect(isAct(act(1, 1), { ...EVERYTHING_OF_NOTE, kind: 'alarm' }, null)).toBe(false);
});

test('the variables of a moment are read by name, and those that changed are known', () => {
	expect([...changedAt({ content: { measured: { a: 1 }, changes: { b: 2 } } })]).toEqual(['a', 'b']);
	expect(changedAt({ content: {} }).size).toBe(0);
	expect(sortedBy(['x', 'y', 'z'], (id) => ({ x: 'bolt 10', y: 'bolt 2', z: 'arm' })[id] ?? '')).toEqual(['z', 'y', 'x']);
});

test('what is older than the end of a page is not taken for known', () => {
	const page = readOf({ records: [record(9, 90), record(8, 80)], next: 8 });
	expect(boundOf(page)).toBe(80);
	expect(boundOf(readOf({ records: [], next: null }))).toBe(-Infinity);
	expect(meets(page, readOf({ records: [record(10, 95), record(9, 90)], next: 9 }))).toBe(true);
	expect(meets(page, readOf({ records: [record(20, 95)], next: 20 }))).toBe(false);
});
