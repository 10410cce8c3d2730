import { expect, test } from 'vitest';
import type { Operation } from '#lib/contract.ts';
import { PLAN, step, view } from '#lib/testing/view.ts';
import { nothingNext } from './status.ts';

const active = { active: true } as Operation;
const idle = { ...PLAN, status: 'idle' as const };
const running = [step('run', 'nutrunner', 0, { status: 'running', started: 990 })];

test.each([
	['production', view({ production: 'waiting', plan: idle, operations: { a: active } })],
	['paused', view({ mode: 'hold', plan: idle })],
	['waits', view({ plan: { ...PLAN, steps: running } })],
	['followed', view()],
	['planning', view({ plan: idle, operations: { a: active } })],
	['idle', view({ plan: idle, operations: { a: { ...active, active: false } } })],
	['none', view({ mode: 'restart', plan: { ...PLAN, status: 'none' } })]
])('no next start is said as %s, and never as nothing to plan while something is active', (said, station) => {
	expect(nothingNext(station)).toBe(said);
});
