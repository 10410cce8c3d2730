import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { SILENCE, ageOf, hear, type Hearing } from './hearing.ts';

interface Message {
	/** Milliseconds since the message before it was made. */
	readonly step: number;
	/** Milliseconds on the way. */
	readonly delay: number;
	/** The share of them, from 0 to 1, for which the server had it and says so; null where it says nothing. */
	readonly kept?: number | null;
}

/** Hears messages made on a controller's clock that is `apart` from this page's; they arrive in order. */
function listen(messages: readonly Message[], apart: number): { hearing: Hearing; arrival: number; made: number } {
	let hearing = SILENCE;
	let arrival = 0;
	let made = 0;
	for (const message of messages) {
		made += message.step;
		arrival = Math.max(arrival, made + message.delay);
		const { kept = null } = message;
		hearing = hear(hearing, arrival, made - apart, kept === null ? null : kept * message.delay);
	}
	return { hearing, arrival, made };
}

const kept = fc.option(fc.double({ min: 0, max: 1, noNaN: true }));
const messages = fc.array(fc.record({ step: fc.integer({ min: 1, max: 900 }), delay: fc.nat(5000), kept }), { minLength: 1 });
const clocks = fc.integer({ min: -1_000_000, max: 1_000_000 });

describe('the age of a document', () => {
	test('is never less than the time since it arrived', () => {
		fc.assert(
			fc.property(messages, clocks, fc.nat(10_000), (sent, apart, later) => {
				const { hearing, arrival } = listen(sent, apart);
				expect(ageOf(hearing, arrival + later)).toBeGreaterThanOrEqual(later);
			})
		);
	});

	test('is never more than it is', () => {
		fc.assert(
			fc.property(messages, clocks, fc.nat(10_000), (sent, apart, later) => {
				const { hearing, arrival, made } = listen(sent, apart);
				expect(ageOf(hearing, arrival + later)).toBeLessThanOrEqual(arrival + later - made);
			})
		);
	});

	test('is what it is once a message came without delay, however far the clocks are apart', () => {
		fc.assert(
			fc.property(clocks, fc.nat(3000), (apart, delay) => {
				const { hearing, arrival } = listen(
					[
						{ step: 10, delay: 0 },
						{ step: 100, delay }
					],
					apart
				);
				expect(ageOf(hearing, arrival)).toBe(delay);
			})
		);
	});

	test('counts a burst after a long silence as old', () => {
		const before = listen(
			Array.from({ length: 100 }, () => ({ step: 100, delay: 5 })),
			0
		);
		let hearing = before.hearing;
		const burst = before.arrival + 120_000;
		for (let k = 1; k <= 50; k++) {
			hearing = hear(hearing, burst, before.made + k * 100);
			expect(ageOf(hearing, burst)).toBeGreaterThan(100_000);
		}
	});

	test('heals within 31 s when the controller sets its clock back', () => {
		let hearing = listen([{ step: 10, delay: 0 }], 0).hearing;
		for (let second = 1; second <= 31; second++) hearing = hear(hearing, second * 1000, second * 1000 - 3_600_000);
		expect(ageOf(hearing, 31_000)).toBe(0);
	});

	test('is not known before anything was heard', () => {
		expect(ageOf(SILENCE, 5)).toBeNull();
	});
});

test('the first document is as old as the server says, and no less live for being the first', () => {
	const once = hear(SILENCE, 10_000, 500, 400);
	expect(once.proven).toBe(true);
	expect(ageOf(once, 10_000)).toBe(400);
});

test('one document alone proves nothing: its controller may be long dead', () => {
	const once = hear(SILENCE, 0, 500);
	expect(once.proven).toBe(false);
	expect(hear(once, 10, 500).proven).toBe(false);
	expect(hear(once, 10, 510).proven).toBe(true);
});
