import fc from 'fast-check';
import { expect, test } from 'vitest';
import { addressOf, lookedAt, type Looked } from './address.ts';

const part = fc.oneof(
	fc.constant(null),
	fc.record({ kind: fc.constantFrom('stage' as const, 'edge' as const), at: fc.nat({ max: 99_999 }) }),
	fc.record({ kind: fc.constant('variable' as const), name: fc.string({ minLength: 1 }) .filter((name) => !/[\n\r\u2028\u2029]/.test(name)) })
);

test('an address leads to what it was made for', () => {
	fc.assert(
		fc.property(fc.record({ pipeline: fc.string({ minLength: 1 }), part, example: fc.option(fc.string({ minLength: 1 })) }), (looked: Looked) => {
			const address = addressOf(looked);
			expect(lookedAt(new URL(address, 'http://station').searchParams)).toEqual(looked);
		})
	);
});

test.each(['?at=stage.1', '?of=&at=stage.1'])('without a pipeline, %s means all of them', (query) => {
	expect(lookedAt(new URLSearchParams(query))).toEqual({ pipeline: null, part: null, example: null });
});

test.each(['stage.x', 'stage', 'edge.-1', 'stage.1.5', 'else.1'])('%s is no part', (at) => {
	expect(lookedAt(new URLSearchParams({ of: '/a', at })).part).toBeNull();
});
