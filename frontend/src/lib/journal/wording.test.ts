import { describe, expect, test } from 'vitest';
import type { Actor, AuditRecord } from '#lib/contract.ts';
import { namesOf } from '#lib/history/names.ts';
import { actText, actorText, becauseText, detailText, subjectText } from './wording.ts';

const EVA: Actor = { kind: 'person', id: 'p1', name: 'Eva' };

const names = namesOf(null);

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
	expect(subjectText(record('acknowledge-task', 'task 4-1', { title: 'Place bolts' }), names)).toBe('Place bolts (task 4-1)');
	expect(subjectText(record('acknowledge-task', 'task 4-1'), names)).toBe('task 4-1');
	expect(subjectText(record('set-mode', '', { mode: 'paused' }), names)).toBe('Paused');
	expect(subjectText(record('person-created', 'person Eva'), names)).toBe('person Eva');
	const changed = { role: ['operator', 'engineer'], disabled: [false, true], sessions_ended: 2 };
	expect(subjectText(record('person-changed', 'person Eva', changed), names)).toBe(
		'person Eva, role: operator → engineer, disabled: no → yes'
	);
	expect(subjectText(record('set-override', 'override ur10.speed', { fields: { speed: 0.25 } }), names)).toBe(
		'override ur10.speed, speed = 0.25'
	);
	const corrected = record('correct-estimates', 'bolts[bolt_pair_1]', { values: { 'bolts[bolt_pair_1]': 'empty' } });
	expect(subjectText(corrected, names)).toBe('Bolts · bolt pair 1: empty');
	expect(subjectText(record('force-variable', 'bolts[bolt_pair_1]', { value: 'placed' }), names)).toBe('Bolts · bolt pair 1: placed');
	expect(subjectText(record('release-force', 'bolts[bolt_pair_1]'), names)).toBe('Bolts · bolt pair 1');
});

test('why it was refused, and every detail, can be read', () => {
	expect(becauseText(record('set-mode', '', { because: 'control-needed' }))).toBe('control is needed');
	expect(becauseText(record('set-mode', '', { because: 'the-moon-is-full' }))).toBe('the moon is full');
	expect(becauseText(record('set-mode', ''))).toBe('');
	expect([true, 3, null, ['read'], 'x'].map(detailText)).toEqual(['yes', '3', 'null', '["read"]', 'x']);
});
