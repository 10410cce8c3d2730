import { describe, expect, test } from 'vitest';
import type { Actor, AuditRecord } from '#lib/contract.ts';
import { actText, actorText, becauseText, detailText, subjectText } from './wording.ts';

const EVA: Actor = { kind: 'person', id: 'p1', name: 'Eva' };

function record(action: string, subject: string, details: AuditRecord['entry']['details'] = {}): AuditRecord {
	return { number: 1, time: 0, hash: '', entry: { actor: EVA, action, subject, details, outcome: 'done' } };
}

test('an act that is not known keeps its own name', () => {
	expect(['sign-in', 'calibrate', 'toString'].map(actText)).toEqual(['Signed in', 'calibrate', 'toString']);
});

describe('who acts', () => {
	test('is called by name, with what it is where that is no person', () => {
		expect(actorText(EVA)).toBe('Eva');
		expect(actorText({ ...EVA, kind: 'watch', name: 'Left wrist' })).toBe('Left wrist (watch)');
		expect(actorText({ ...EVA, kind: 'key', name: 'MES' })).toBe('MES (key)');
	});

	test('is never taken for the person whose name was only typed in', () => {
		expect(actorText({ ...EVA, id: 'unknown' })).toBe('somebody unknown, as “Eva”');
		expect(actorText({ kind: 'watch', id: 'unknown', name: 'unknown' })).toBe('somebody unknown');
	});
});

test('on what it was done is said by its title, and with what was changed', () => {
	expect(subjectText(record('acknowledge-task', 'task 4-1', { title: 'Place bolts' }))).toBe('Place bolts (task 4-1)');
	expect(subjectText(record('acknowledge-task', 'task 4-1'))).toBe('task 4-1');
	expect(subjectText(record('set-mode', '', { mode: 'paused' }))).toBe('paused');
	expect(subjectText(record('person-created', 'person Eva'))).toBe('person Eva');
	const changed = { role: ['operator', 'engineer'], disabled: [false, true], sessions_ended: 2 };
	expect(subjectText(record('person-changed', 'person Eva', changed))).toBe(
		'person Eva, role: operator → engineer, disabled: no → yes'
	);
	expect(subjectText(record('set-override', 'override ur10.speed', { fields: { speed: 0.25 } }))).toBe(
		'override ur10.speed, speed = 0.25'
	);
	const corrected = record('correct-estimates', 'bolts[bolt_pair_1]', { values: { 'bolts[bolt_pair_1]': 'empty' } });
	expect(subjectText(corrected)).toBe('bolts[bolt_pair_1] = empty');
});

test('why it was refused, and every detail, can be read', () => {
	expect(becauseText(record('set-mode', '', { because: 'control-needed' }))).toBe('control needed');
	expect(becauseText(record('set-mode', ''))).toBe('');
	expect([true, 3, null, ['read'], 'x'].map(detailText)).toEqual(['yes', '3', 'null', '["read"]', 'x']);
});
