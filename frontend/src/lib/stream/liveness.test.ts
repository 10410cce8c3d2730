import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { view } from '#lib/testing/view.ts';
import { SILENCE, hear } from './hearing.ts';
import { OLD_AFTER, judge } from './liveness.ts';
import { NOTHING, receive } from './receive.ts';

const stream = receive(NOTHING, { kind: 'snapshot', sequence: 1, age: null, view: view() });
const hearing = hear(hear(SILENCE, 0, 0), 100, 100);

describe('what is shown', () => {
	test('is live while it is young', () => {
		expect(judge(stream, hearing, true, 180)).toEqual({ live: true, age: 80 });
	});

	test('is never live when older than the limit', () => {
		fc.assert(
			fc.property(fc.integer({ min: OLD_AFTER + 1, max: 1e9 }), (age) => {
				expect(judge(stream, hearing, true, 100 + age)).toEqual({ live: false, age, cause: 'silent' });
			})
		);
	});

	test('is said to be old within two seconds', () => {
		expect(OLD_AFTER).toBeLessThan(1850);
	});

	test.each([
		['the connection is closed', stream, hearing, false, 'closed'],
		['the controller is lost', { ...stream, controller: 'lost' } as const, hearing, true, 'controller'],
		['a message is missing', { ...stream, gap: true }, hearing, true, 'gap'],
		['its time is no number', stream, hear(hearing, 200, NaN), true, 'silent'],
		['only one document came', stream, hear(SILENCE, 100, 100), true, 'connecting'],
		['the only document was old when it came', stream, hear(SILENCE, 100, 100, OLD_AFTER + 1), true, 'silent'],
		[
			'the server has never heard the controller',
			{ ...NOTHING, controller: 'lost' } as const,
			SILENCE,
			true,
			'controller'
		],
		['nothing came', NOTHING, SILENCE, true, 'connecting'],
		['the server was never reached', NOTHING, SILENCE, false, 'closed']
	])('is not live when %s', (_, known, heard, open, cause) => {
		expect(judge(known, heard, open, 100)).toMatchObject({ live: false, cause });
	});
});
