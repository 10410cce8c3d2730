import { describe, expect, test } from 'vitest';
import type { Actor, AuditRecord } from '#lib/contract.ts';
import { namesOf } from '#lib/history/names.ts';
import { actText, actorText, becauseText, detailText, subjectText, whereText } from './wording.ts';

const EVA: Actor = { kind: 'person', id: 'p1', name: 'Eva' };

const names = namesOf(null);

function record(action: string, subject: string, details: AuditRecord['entry']['details'] = {}): AuditRecord {
	return { number: 1, time: 0, hash: '', entry: { actor: EVA, action, subject, details, outcome: 'done' } };
}

test('an act that is not known keeps its own name', () => {
	expect(['sign-in', 'calibrate', 'toString'].map(actText)).toEqual(['Signed in', 'calibrate', 'toString']);
});

test('from where somebody acts is said in words, and which session it was is not', () => {
	expect(whereText({ address: '10.0.0.7' })).toBe('10.0.0.7');
	expect(whereText({ address: 'the command line of root' })).toBe('command line, root');
	expect(whereText({})).toBe('');
	expect(subjectText(record('sign-in', 'session 3f9a'), names)).toBe('');
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
	expect(subjectText(record('acknowledge-task', 'task 4-1', { title: 'Place bolts' }), names)).toBe('Place bolts');
	expect(subjectText(record('acknowledge-task', 'task 4-1'), names)).toBe('task 4-1');
	expect(subjectText(record('set-mode', '', { mode: 'paused' }), names)).toBe('Paused');
	expect(subjectText(record('job-order-stored', 'job order 4711', { description: 'Engine 4711' }), names)).toBe('Engine 4711 (job order 4711)');
	expect(subjectText(record('job-order-stored', 'job order 4711', { description: '4711' }), names)).toBe('job order 4711');
	expect(subjectText(record('take-job', 'job 4711', { title: 'Engine 4711' }), names)).toBe('Engine 4711 (job 4711)');
	expect([true, false].map((on) => subjectText(record('work-by-order', '', { on }), names))).toEqual(['by order', 'freely']);
	expect([true, false].map((on) => subjectText(record('set-stepping', '', { on }), names))).toEqual(['on', 'off']);
	expect(subjectText(record('set-service', 'resource robot', { of: 'resource', name: 'robot', in_service: false }), names)).toBe(
		'robot: out of service'
	);
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

test('what somebody thinks of a revision says who saved it, and a deployment who has approved it', () => {
	const said = (action: string, details: AuditRecord['entry']['details']): string => {
		const about = record(action, 'revision Bolts', details);
		return `${actText(action)}: ${subjectText(about, names)}`;
	};
	expect(said('revision-approved', { revision: 'a', saved_by: 'Eva' })).toBe('Approved a revision: revision Bolts, saved by Eva');
	expect(said('revision-changes-requested', { saved_by: 'Eva' })).toBe('Asked for changes in a revision: revision Bolts, saved by Eva');
	expect(said('deploy', { approved_by: ['Adam', 'Maria'] })).toBe('Deployed a revision: revision Bolts, approved by Adam and Maria');
	expect(said('deploy', { approved_by: [] })).toBe('Deployed a revision: revision Bolts');
	expect(said('deploy', {})).toBe('Deployed a revision: revision Bolts');
});

test('why it was refused, and every detail, can be read', () => {
	expect(becauseText(record('set-mode', '', { because: 'control-needed' }))).toBe('control is needed');
	expect(becauseText(record('set-mode', '', { because: 'the-moon-is-full' }))).toBe('the moon is full');
	expect(becauseText(record('set-mode', ''))).toBe('');
	expect([true, 3, null, ['read'], 'x'].map(detailText)).toEqual(['yes', '3', 'null', '["read"]', 'x']);
});
