import { expect, test } from 'vitest';
import type { ModelCheck } from '#lib/contract.ts';
import { secondsOf } from '#lib/workshop/verdict.ts';
import { lookedFor } from './checks.ts';

const CHECK: ModelCheck = { number: 1, state: 'checking', doing: 'the safe states', doing_message: null, looked: [], findings: [], summary: null, analysis: null };
const looked = (...all: [string, number][]): ModelCheck['looked'] => all.map(([what, seconds]) => ({ what, what_message: null, seconds }));
const cameOf = (check: ModelCheck): string[] => lookedFor(check).map(({ came }) => came);
const ERROR: ModelCheck['findings'][number] = { severity: 'error', kind: 'x', file: 'a', line: 1, column: 1, message: 'm', said: null, members: [], trace: null, fixes: [] };

test('what is over has its time, and what is under way has none yet', () => {
	const check = { ...CHECK, looked: looked(['reading it', 0.1], ['the examples of pipelines', 0.6], ['what is suspicious', 0.8]) };
	expect(cameOf(check)).toEqual(['done', 'done', 'done', 'now', 'later', 'later']);
	expect(lookedFor(check)[1]?.seconds).toBe(0.6);
	expect(secondsOf(check)).toBeCloseTo(1.5);
});

test('what was known of this very model before is passed, without a time', () => {
	const analysis = { supervised: true } as unknown as NonNullable<ModelCheck['analysis']>;
	const done = { ...CHECK, state: 'done' as const, doing: '', looked: looked(['reading it', 0.1]), analysis };
	expect(cameOf(done)).toEqual(Array.from({ length: 6 }, () => 'done'));
	expect(lookedFor(done)[5]?.seconds).toBeNull();
});

test('a draft that cannot be used has failed where it was given up, and nothing came after that', () => {
	const broken = { ...CHECK, state: 'done' as const, doing: '', findings: [ERROR] };
	expect(cameOf(broken)).toEqual(['bad', 'later', 'later', 'later', 'later', 'later']);
	const later = { ...broken, looked: looked(['reading it', 0.1], ['the examples of pipelines', 0.2]) };
	expect(cameOf(later)).toEqual(['done', 'bad', 'later', 'later', 'later', 'later']);
});

test('without a supervisor it is the safe states that are missing', () => {
	const unmet = { ...CHECK, state: 'done' as const, doing: '', looked: looked(['reading it', 1]), analysis: { supervised: false } as unknown as NonNullable<ModelCheck['analysis']> };
	expect(cameOf(unmet)).toEqual(['done', 'done', 'done', 'bad', 'later', 'later']);
});
