import { expect, test } from 'vitest';
import type { Finding, ModelCheck } from '#lib/contract.ts';
import { countsOf, stageOf, verdictOf } from './verdict.ts';

const ANALYSIS: NonNullable<ModelCheck['analysis']> = {
	pending: null,
	pending_message: null,
	supervised: true,
	reachable_states: null,
	supervised_states: null,
	supervised_at_most: null,
	guarded: null,
	guards: {},
	lifted: [],
	findings: null
};
const DONE: ModelCheck = { number: 3, state: 'done', doing: '', doing_message: null, looked: [], findings: [], summary: null, analysis: ANALYSIS };

function found(severity: string): Finding {
	return { severity, kind: 'x', file: 'a.yaml', line: 1, column: 1, message: 'It is so', said: null, members: [], trace: null, fixes: [] };
}

test('a check that is done says whether the draft can be used, and supervised', () => {
	expect(verdictOf(DONE)).toBe('good');
	expect(verdictOf({ ...DONE, findings: [found('warning')] })).toBe('good');
	expect(verdictOf({ ...DONE, findings: [found('error')], analysis: null })).toBe('unusable');
	expect(verdictOf({ ...DONE, analysis: { ...ANALYSIS, supervised: false } })).toBe('unmeetable');
	expect(verdictOf({ ...DONE, analysis: null })).toBe('unmeetable');
});

test('one that is not done says nothing of that yet', () => {
	expect(verdictOf({ ...DONE, state: 'checking', findings: [found('error')] })).toBe('checking');
	expect(verdictOf({ ...DONE, state: 'waiting' })).toBe('waiting');
	expect(verdictOf({ ...DONE, state: 'failed' })).toBe('failed');
});

test('errors and warnings are counted apart', () => {
	expect(countsOf([found('warning'), found('error'), found('warning')])).toEqual({ errors: 1, warnings: 2 });
});

test('a check goes through its stages', () => {
	const at = (state: ModelCheck['state'], doing: string): number | null => stageOf({ state, doing });
	expect(at('waiting', 'the check begins')).toBe(-1);
	expect(at('checking', 'reading it')).toBe(0);
	expect(at('checking', 'the safe states')).toBe(3);
	expect(at('checking', 'why they are none')).toBe(4);
	expect(at('checking', 'the guards')).toBe(5);
	expect(at('checking', 'something new')).toBeNull();
	expect(at('done', '')).toBe(6);
});
